"""What a certificate says of a map, as its JSON has it, and what has to be zero for that.

The formats are told in `every`. In the plane a 2-form is its one entry.

A ring's polynomials as a certificate's checker takes them: nothing is reduced.

So what has to be zero is the same polynomial here and there.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring
from verify.errors import NOT_GIVEN, InputError
from verify.hamiltonians.coordinates import PLANE
from verify.proof.certificates.by_coefficients import terms
from verify.proof.certificates.checker import see_witness
from verify.proof.certificates.file import FORMAT, Certificate
from verify.schemes.steps.two_form import TwoForm

_KINDS = ("sin", "cos", "exp", "inverse")


class Plain:
    """A ring's polynomials with derivatives by the coordinates and t by the chain rule, and nothing
    reduced."""

    def __init__(self, ring: Ring, coordinates: tuple[str, ...]) -> None:
        self.ring, self.coordinates = ring, coordinates
        self.variables = (*coordinates, *("t",) * ("t" in ring.variables))
        self.names = {
            g.index: g.name if g.kind == "variable" else f"#{g.index}" for g in ring.generators
        }
        made = [g for g in ring.generators if g.kind != "variable"]
        for g in made:
            if g.kind not in _KINDS:
                raise InputError(
                    "hamiltonian",
                    ring.text(ring.context.gens()[g.index]),
                    "no certificate: it takes sin, cos, exp, denominators",
                )
        self.functions = [[self.names[g.index], g.kind, terms(g.inner, self.names)] for g in made]
        self._images: dict[int, dict[str, Poly]] = {}
        gens = ring.context.gens()
        for g in made:
            own = gens[g.index]
            partner = {"sin": "cos", "cos": "sin"}.get(g.kind)
            side = (partner and ring.find(partner, g.inner)) or ring.zero
            slope = {"sin": side, "cos": -side, "exp": own, "inverse": -(own**2)}[g.kind]
            self._images[g.index] = {by: slope * self.diff(g.inner, by) for by in self.variables}

    def diff(self, x: Poly, by: str) -> Poly:
        total = x.derivative(self.ring.room + self.ring.variables.index(by))
        degrees = x.degrees()
        for index, image in self._images.items():
            if degrees[index] > 0:
                total += x.derivative(index) * image[by]
        return total

    def without_constants(self, x: Poly, variables: tuple[str, ...] = ()) -> Poly:
        """Without the terms that depend on none of these variables, or of the coordinates."""
        variables = variables or self.coordinates
        terms = {m: c for m, c in terms_of(x) if any(self._has(m, by) for by in variables)}
        return self.ring.context.from_dict(terms)

    def _has(self, monomial: tuple[int, ...], by: str) -> bool:
        term = self.ring.context.from_dict({monomial: 1})
        return not self.diff(term, by).is_zero()

    def cofactors(self, x: Poly) -> dict[str, list[list[str]]]:
        """By which Σ cofactor·relation is x; InputError where reducing does not end at 0."""
        found: dict[int, Poly] = {}
        for index, power, relation in reversed(self.ring.relations):
            if x.degrees()[index] >= power:
                quotient, x = divmod(x, relation)
                found[index] = found.get(index, self.ring.zero) + quotient
        if not x.is_zero():
            raise InputError("proof", str(x)[:60], "no certificate: zero is not seen by reducing")
        return {self.names[index]: terms(c, self.names) for index, c in found.items()}


_TRIED = 20  # points
Form = Mapping[tuple[str, str], Poly]  # entries above the diagonal
Names = Mapping[int, str]


def entries_of(form: TwoForm | None) -> Form:
    """Its entries by the names of their coordinates; of None, which is 0, none."""
    if form is None:
        return {}
    return {(form.names[a], form.names[b]): x for (a, b), x in form.entries.items()}


def in_the_plane(x: Poly) -> Form:
    """x dp∧dq."""
    return {} if x.is_zero() else {("p", "q"): x}


@dataclass(frozen=True)
class Statement:
    """`rows`: the coefficients of h⁰, h¹, … in each coordinate's new value, as far as they are
    needed. `order`, `leading`: of S, or in the plane of det J − 1, None and no entry where it is
    0; `potential`: None where there is none."""

    coordinates: tuple[str, ...]
    rows: Sequence[Sequence[Poly]]
    order: int | None
    convergence_order: int
    leading: Form
    potential: Form | None = None

    @property
    def planar(self) -> bool:
        """Whether it is of p and q."""
        return self.coordinates == PLANE

    def written(self, names: Names) -> Certificate:
        """As the certificate's entries; `names`: of the variables by their index."""
        after = [[terms(x, names) for x in row] for row in self.rows]
        new = dict(zip(self.coordinates, after, strict=True))
        return {
            "order": self.order,
            "convergence_order": self.convergence_order,
            "leading": self._form(self.leading, names),
            **({f"{x}_next": row for x, row in new.items()} if self.planar else {"next": new}),
            **({} if self.potential is None else {"potential": self._form(self.potential, names)}),
        }

    def _form(self, form: Form, names: Names) -> list[list[Any]]:
        if self.planar:
            return [term for x in form.values() for term in terms(x, names)]
        return [[a, b, terms(x, names)] for (a, b), x in form.items()]


def certificate_of_one(
    statement: Statement, plain: Plain, energy: Poly, witness: Mapping[str, Fraction]
) -> Certificate:
    """The certificate of what is said for one H, `energy`, in the ring of `plain`; `witness`: a
    point that the proof has."""
    coordinates, variables = statement.coordinates, plain.ring.variables
    data = {
        "format": FORMAT,
        **({} if statement.planar else {"degrees": len(coordinates) // 2}),
        "hamiltonian": terms(plain.without_constants(energy), plain.names),
        **({"time_dependent": True} if "t" in variables else {}),
        "parameters": [name for name in variables if name not in (*coordinates, "h", "t")],
        "functions": plain.functions,
        **statement.written(plain.names),
        "cofactors": {},
    }
    data["witness"] = _witness(data, coordinates, witness)
    zeros = _zeros(plain, statement, energy)  # what is zero as it stands has no cofactors
    data["cofactors"] = {what: plain.cofactors(x) for what, x in zeros if not x.is_zero()}
    return data


def _witness(
    data: Certificate, coordinates: tuple[str, ...], known: Mapping[str, Fraction]
) -> dict[str, str]:
    """A point at which the checker sees what is not 0: the proof's own, or one that is tried."""
    timed = ("t",) if data.get("time_dependent") else ()
    names = (*coordinates, *timed, *data["parameters"])
    for k in range(_TRIED):
        tried = {name: Fraction(7 + 4 * k + i, 17 + 2 * i) for i, name in enumerate(names)}
        at = {name: str(known.get(name, value)) for name, value in tried.items()}
        for witness in ({}, at):
            try:
                see_witness(data | {"witness": witness})
            except ValueError:
                continue
            return witness
    raise InputError(
        "proof", NOT_GIVEN, "no certificate: no point is found where no denominator is 0"
    )


def _zeros(plain: Plain, statement: Statement, energy: Poly) -> Iterator[tuple[str, Poly]]:
    """What has to be zero, each by its name in the checker's words."""
    ring, names, order = plain.ring, statement.coordinates, statement.order
    n, zero, leading = len(names) // 2, plain.ring.zero, statement.leading
    first = [plain.diff(energy, name) for name in names]
    slopes = dict(zip(names, [-x for x in first[n:]] + first[:n], strict=True))

    def along_flow(y: Poly) -> Poly:
        total = plain.diff(y, "t") if "t" in plain.variables else zero
        for name, slope in slopes.items():
            total += slope * plain.diff(y, name)
        return total

    for name, row in zip(names, statement.rows, strict=True):
        flow = ring.variable(name)
        for k in range(statement.convergence_order + 1):
            yield f"{name} {k}", (row[k] if k < len(row) else zero) - flow / math.factorial(k)
            flow = along_flow(flow)
    gradients = [[{by: plain.diff(x, by) for by in names} for x in row] for row in statement.rows]
    for m in range(1, (order or 2 * max(map(len, statement.rows))) + 1):
        for a, b in combinations(names, 2):
            gap = -leading.get((a, b), zero) if m == order else zero
            for p, q in zip(gradients[:n], gradients[n:], strict=True):
                for k in range(max(0, m - len(q) + 1), min(m + 1, len(p))):
                    gap += p[k][a] * q[m - k][b] - p[k][b] * q[m - k][a]
            yield f"det {m}" if statement.planar else f"S {m} {a} {b}", gap
    potential = statement.potential
    if potential is None:
        return

    def at(a: str, b: str) -> Poly:
        return -potential[b, a] if (b, a) in potential else potential.get((a, b), zero)

    for a, b in combinations(names, 2):
        gap = along_flow(at(a, b)) - leading.get((a, b), zero)
        for c, slope in () if statement.planar else slopes.items():  # there they cancel
            gap += plain.diff(slope, a) * at(c, b) + at(a, c) * plain.diff(slope, b)
        yield "potential" if statement.planar else f"potential {a} {b}", gap
