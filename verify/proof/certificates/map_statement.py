"""The statement of a certificate about a map, in its JSON, with the cofactors that prove it.

The format is described in `certification`. The residuals, which must be zero, come from the
checker's own identities for the certificate as it is read. The checker does not reduce them; the
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

_MOST_WITNESSES = 20  # limit of the points that are tried
Form = Mapping[tuple[str, str], Poly]  # entries above the diagonal
Names = Mapping[int, str]


def entries_of(form: TwoForm | None) -> Form:
    """Return the form's entries by the names of two coordinates; none for None."""
    if form is None:
        return {}
    return {(form.names[a], form.names[b]): x for (a, b), x in form.entries.items()}


def layout_of(coordinates: tuple[str, ...]) -> CoordinateLayout:
    """Return the layout of a certificate with these coordinates."""
    return layout_in(None if coordinates == PLANE else len(coordinates) // 2)


def degrees_of(layout: CoordinateLayout) -> dict[str, int]:
    """Return the certificate's entry `degrees`; none in the plane."""
    return {} if layout.single else {"degrees": layout.degrees}


@dataclass(frozen=True)
class Statement:
    """The statement about a map.

    `rows`: the coefficients of h⁰, h¹, … in each coordinate's new value, as far as they are needed.
    `order`, `leading`: those of S, in the plane of det J − 1; None and no entries if it is 0.
    `potential`: the potential of `leading`; None if there is none.
    """

    layout: CoordinateLayout
    rows: Sequence[Sequence[Poly]]
    order: int | None
    convergence_order: int
    leading: Form
    potential: Form | None = None

    def entries(self, names: Names) -> Certificate:
        """Return the certificate's entries; `names[k]` is the name of variable k."""
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
    """Return the certificate of a statement for the H of a field; `point`: the proof's witness."""
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
    # The checker's own code runs on the data, first to find a witness and then to list residuals:
    # so the cofactors are for exactly the polynomials that the checker will form.
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
    for k in range(_MOST_WITNESSES):
        # Fractions in an irregular sequence, at which formulas are unlikely to vanish.
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
    """Yield the residuals, until the checker refuses the certificate."""
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
    # Relations of newer generators contain older generators and not the other way round: one pass
    # from the newest to the oldest reduces x completely.
    for index, power, relation in reversed(ring.relations):
        if x.degrees()[index] >= power:
            quotient, x = divmod(x, relation)
            cofactors[index] = cofactors.get(index, ring.zero) + quotient
    if not x.is_zero():
        raise InputError("proof", str(x)[:60], "no certificate: zero is not seen by reducing")
    return {names[index]: terms(c, names) for index, c in cofactors.items()}
