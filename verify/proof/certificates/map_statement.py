"""The statement of a certificate about a map, in its JSON, with the cofactors that prove it.

The format is described in `certification`. The polynomials that must be zero come from the
checker's own identities, for the certificate as it is read: they are not reduced there, and the
cofactors that reduce them to 0 are written into the certificate.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.algebra.identities.polynomials import Generator, terms_of
from verify.algebra.ring import Poly, Ring
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.canonical_field import CanonicalField
from verify.proof.certificates.certificate_file import FORMAT, Certificate
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.coefficient_entries import polynomial_in, terms
from verify.proof.certificates.entries import KINDS, Expansion, read
from verify.proof.certificates.readers import PLANE, CoordinateLayout, layout_in
from verify.proof.certificates.readers import Poly as Read
from verify.schemes.steps.two_form import TwoForm

_MOST_TRIED = 20  # points
Form = Mapping[tuple[str, str], Poly]  # entries above the diagonal
Names = Mapping[int, str]


def entries_of(form: TwoForm | None) -> Form:
    """Return the form's entries by the names of their coordinates; none for None, which is 0."""
    if form is None:
        return {}
    return {(form.names[a], form.names[b]): x for (a, b), x in form.entries.items()}


def layout_of(coordinates: tuple[str, ...]) -> CoordinateLayout:
    """Return the layout of a certificate with these coordinates."""
    return layout_in(None if coordinates == PLANE else len(coordinates) // 2)


def degrees_of(layout: CoordinateLayout) -> dict[str, int]:
    """Return the entry `degrees`; none in the plane."""
    return {} if layout.single else {"degrees": layout.degrees}


@dataclass(frozen=True)
class Statement:
    """The statement about a map.

    `rows`: the coefficients of h⁰, h¹, … in each coordinate's new value, as far as they are
    needed. `order`, `leading`: of S, or in the plane of det J − 1, None and no entry where it is
    0; `potential`: None if there is none.
    """

    layout: CoordinateLayout
    rows: Sequence[Sequence[Poly]]
    order: int | None
    convergence_order: int
    leading: Form
    potential: Form | None = None

    def entries(self, names: Names) -> Certificate:
        """Return the certificate's entries; `names`: of the variables by their index."""
        after = [[terms(x, names) for x in row] for row in self.rows]
        new = dict(zip(self.layout.coordinates, after, strict=True))
        return {
            "order": self.order,
            "convergence_order": self.convergence_order,
            "leading": self._form(self.leading, names),
            **(
                {f"{x}_next": row for x, row in new.items()}
                if self.layout.single
                else {"next": new}
            ),
            **({} if self.potential is None else {"potential": self._form(self.potential, names)}),
        }

    def _form(self, form: Form, names: Names) -> list[Any]:
        if self.layout.single:
            return [term for x in form.values() for term in terms(x, names)]
        return [[a, b, terms(x, names)] for (a, b), x in form.items()]


def certificate_for_one_h(
    statement: Statement, field: CanonicalField, point: Mapping[str, Fraction]
) -> Certificate:
    """Write the certificate of the statement for the H of this field; `point`: the proof's."""
    ring = field.ring
    functions = [g for g in ring.generators if g.kind != "variable"]
    names = {g.index: g.name or f"#{g.index}" for g in ring.generators}
    parameters = [name for name in ring.variables if name not in (*field.names, "h", "t")]
    data = {
        "format": FORMAT,
        **degrees_of(statement.layout),
        "hamiltonian": terms(without_constants(ring, field.energy, field.names), names),
        **({"time_dependent": True} if field.timed else {}),
        "parameters": parameters,
        "functions": [_function(ring, g, names) for g in functions],
        **statement.entries(names),
        "cofactors": {},
    }
    points = (*field.names, *("t",) * field.timed, *parameters)
    # The checker itself runs on the data, once to find a witness and once to list the residuals:
    # so the certificate is written for exactly the polynomials that the checker will form.
    data["witness"] = _witness(data, points, point)
    places = {name: index for index, name in names.items()}
    residuals = (
        (identity, polynomial_in(ring.context, places, x)) for identity, x in _residuals(data)
    )
    data["cofactors"] = {
        identity: _cofactors(ring, x, names) for identity, x in residuals if not x.is_zero()
    }
    return data


def _function(ring: Ring, g: Generator, names: Names) -> list[Any]:
    if g.kind not in KINDS:
        raise InputError(
            "hamiltonian",
            ring.text(ring.context.gens()[g.index]),
            "no certificate: it takes sin, cos, exp, denominators",
        )
    return [names[g.index], g.kind, terms(g.inner, names)]


def without_constants(ring: Ring, x: Poly, variables: Sequence[str]) -> Poly:
    """Drop the terms that depend on none of these variables."""
    single = ((m, c, ring.context.from_dict({m: 1})) for m, c in terms_of(x))
    dependent = {
        m: c for m, c, term in single if any(ring.depends(term, name) for name in variables)
    }
    return ring.context.from_dict(dependent)


def _witness(
    data: Certificate, names: Sequence[str], point: Mapping[str, Fraction]
) -> dict[str, str]:
    """Find a point at which the checker sees that L is not 0: the proof's own, or another."""
    for k in range(_MOST_TRIED):
        # Fractions without a pattern that the zeros of a formula could share.
        candidate = {name: Fraction(7 + 4 * k + i, 17 + 2 * i) for i, name in enumerate(names)}
        point_as_text = {name: str(point.get(name, value)) for name, value in candidate.items()}
        for witness in ({}, point_as_text):
            try:
                _identities(data | {"witness": witness}).check_witness()
            except ValueError:
                continue
            return witness
    raise InputError(
        "proof", NOT_GIVEN, "no certificate: no point is found where no denominator is 0"
    )


def _residuals(data: Certificate) -> Iterator[tuple[str, Read]]:
    """Yield the polynomials that must be 0, until the checker finds the certificate too large."""
    try:
        yield from _identities(data).residuals()
    except ValueError:
        return


def _identities(data: Certificate) -> Identities:
    entries = read(data)
    assert isinstance(entries, Expansion)  # noqa: S101 - no scheme for every H
    return Identities(entries)


def _cofactors(ring: Ring, x: Poly, names: Names) -> dict[str, list[list[str]]]:
    """Find the cofactors with x = Σ cofactor·relation; InputError if x is not reduced to 0."""
    cofactors: dict[int, Poly] = {}
    # Relations of newer generators bring in older ones and not the other way round, so one pass
    # from the newest to the oldest reduces x completely.
    for index, power, relation in reversed(ring.relations):
        if x.degrees()[index] >= power:
            quotient, x = divmod(x, relation)
            cofactors[index] = cofactors.get(index, ring.zero) + quotient
    if not x.is_zero():
        raise InputError("proof", str(x)[:60], "no certificate: zero is not seen by reducing")
    return {names[index]: terms(c, names) for index, c in cofactors.items()}
