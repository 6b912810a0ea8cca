"""What a certificate says of a map, as its JSON has it, and why that is so.

The formats are told in `every`. What has to be zero is made by the checker's own identities, of the
certificate as it is read: nothing in them is reduced, and what reduces them to 0 is written down.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.algebra.generator import Generator, terms_of
from verify.algebra.ring import Poly, Ring
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.canonical_field import CanonicalField
from verify.proof.certificates.by_coefficients import polynomial, terms
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import KINDS, Expansion, read
from verify.proof.certificates.file import FORMAT, Certificate
from verify.proof.certificates.readers import PLANE, Layout, layout_in
from verify.proof.certificates.readers import Poly as Read
from verify.schemes.steps.two_form import TwoForm

_TRIED = 20  # points
Form = Mapping[tuple[str, str], Poly]  # entries above the diagonal
Names = Mapping[int, str]


def entries_of(form: TwoForm | None) -> Form:
    """Its entries by the names of their coordinates; of None, which is 0, none."""
    if form is None:
        return {}
    return {(form.names[a], form.names[b]): x for (a, b), x in form.entries.items()}


def layout_of(coordinates: tuple[str, ...]) -> Layout:
    """That of a certificate with these coordinates."""
    return layout_in(None if coordinates == PLANE else len(coordinates) // 2)


def degrees_of(layout: Layout) -> dict[str, int]:
    """The entry that says of which it is."""
    return {} if layout.single else {"degrees": layout.degrees}


@dataclass(frozen=True)
class Statement:
    """`rows`: the coefficients of h⁰, h¹, … in each coordinate's new value, as far as they are
    needed. `order`, `leading`: of S, or in the plane of det J − 1, None and no entry where it is
    0; `potential`: None where there is none."""

    layout: Layout
    rows: Sequence[Sequence[Poly]]
    order: int | None
    convergence_order: int
    leading: Form
    potential: Form | None = None

    def written(self, names: Names) -> Certificate:
        """As the certificate's entries; `names`: of the variables by their index."""
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


def certificate_of_one(
    statement: Statement, field: CanonicalField, known: Mapping[str, Fraction]
) -> Certificate:
    """The certificate of what is said for the H of this field; `known`: a point that the proof
    has."""
    ring = field.ring
    made = [g for g in ring.generators if g.kind != "variable"]
    names = {g.index: g.name or f"#{g.index}" for g in ring.generators}
    parameters = [name for name in ring.variables if name not in (*field.names, "h", "t")]
    data = {
        "format": FORMAT,
        **degrees_of(statement.layout),
        "hamiltonian": terms(without_constants(ring, field.energy, field.names), names),
        **({"time_dependent": True} if field.timed else {}),
        "parameters": parameters,
        "functions": [_function(ring, g, names) for g in made],
        **statement.written(names),
        "cofactors": {},
    }
    points = (*field.names, *("t",) * field.timed, *parameters)
    data["witness"] = _witness(data, points, known)
    places = {name: index for index, name in names.items()}
    gaps = ((what, polynomial(ring.context, places, x)) for what, x in _gaps(data))
    data["cofactors"] = {what: _cofactors(ring, x, names) for what, x in gaps if not x.is_zero()}
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
    """Without the terms that depend on none of these variables."""
    single = ((m, c, ring.context.from_dict({m: 1})) for m, c in terms_of(x))
    kept = {m: c for m, c, term in single if any(ring.depends(term, by) for by in variables)}
    return ring.context.from_dict(kept)


def _witness(
    data: Certificate, names: Sequence[str], known: Mapping[str, Fraction]
) -> dict[str, str]:
    """A point at which the checker sees what is not 0: the proof's own, or one that is tried."""
    for k in range(_TRIED):
        tried = {name: Fraction(7 + 4 * k + i, 17 + 2 * i) for i, name in enumerate(names)}
        at = {name: str(known.get(name, value)) for name, value in tried.items()}
        for witness in ({}, at):
            try:
                _identities(data | {"witness": witness}).check_witness()
            except ValueError:
                continue
            return witness
    raise InputError(
        "proof", NOT_GIVEN, "no certificate: no point is found where no denominator is 0"
    )


def _gaps(data: Certificate) -> Iterator[tuple[str, Read]]:
    """What has to be zero, as far as the checker goes, which says itself where it is too large."""
    try:
        yield from _identities(data).gaps()
    except ValueError:
        return


def _identities(data: Certificate) -> Identities:
    entries = read(data)
    assert isinstance(entries, Expansion)  # noqa: S101 - no scheme for every H
    return Identities(entries)


def _cofactors(ring: Ring, x: Poly, names: Names) -> dict[str, list[list[str]]]:
    """By which Σ cofactor·relation is x; InputError where reducing does not end at 0."""
    found: dict[int, Poly] = {}
    for index, power, relation in reversed(ring.relations):
        if x.degrees()[index] >= power:
            quotient, x = divmod(x, relation)
            found[index] = found.get(index, ring.zero) + quotient
    if not x.is_zero():
        raise InputError("proof", str(x)[:60], "no certificate: zero is not seen by reducing")
    return {names[index]: terms(c, names) for index, c in found.items()}
