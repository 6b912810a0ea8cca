"""A step's values as exact algebra has them: series in h, or elements of a ring with h.

From them a structure makes the defect of a step (see `verify.structures.structure.StepValues`). A
series is known for every smooth step; the elements, of a map that is written out, decide whether
the defect is the zero function.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from verify.algebra.embedding import MAX_TERMS, embed
from verify.algebra.formula import symbol
from verify.algebra.power_series import Derivatives, Series, expand_at
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.canonical_field import CanonicalField, PlainField, field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.proof.expansion import closed_series_of
from verify.schemes.maps.solved_stages import write_out
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.composition import compose, moves_of, reverse, start_of, step_back
from verify.schemes.steps.step_algebra import State, Step
from verify.structures import Structure
from verify.structures.conformal import Conformal
from verify.structures.reversible import Reversible
from verify.structures.symmetric import Symmetric

_MOST_WRITTEN = 4000  # terms of z', in all coordinates, of a map into which formulas are put


class SeriesValues:
    """The values as series up to h^most, over the ring of `field`."""

    def __init__(
        self,
        field: PlainField,
        step: State,
        elements: Mapping[sympy.Expr, Poly],
        turned: Sequence[Series] = (),
        operations: Step | None = None,
    ) -> None:
        """`step`: z'. `elements`: the formulas of the structure in the ring; `turned`: the series
        of ρ∘Φ_h∘ρ, if it has a reflection ρ; `operations`: those that make z', if it has any."""
        self.field, self.step, self.most = field, step, step[0].most
        self._elements, self._turned, self._operations = elements, turned, operations

    @property
    def names(self) -> tuple[str, ...]:
        return self.field.names

    def number(self, x: Fraction) -> Series:
        return self._constant(self.field.ring.constant(x))

    def before(self, formula: sympy.Expr) -> Series:
        return self._constant(self._elements[formula])

    def after(self, formula: sympy.Expr) -> Series:
        element = Derivatives(self.field.ring, self._elements[formula])
        return expand_at(element, self._moves, self.most)

    def factor(self, formula: sympy.Expr) -> Series:
        coefficients = [self._elements[x] for x in taylor_coefficients(formula, self.most)]
        return Series.from_coefficients(self.field.ring, coefficients, self.most)

    @cached_property
    def jacobian(self) -> list[list[Series]]:
        return [[x.diff(name) for name in self.names] for x in self.step]

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> list[Series]:
        if reflection is None and self._operations is not None:
            ends = step_back(self.field, self._operations, self.step)
        else:
            companion = self._turned if reflection else [reverse(x) for x in self.step]
            ends = compose(self.field, companion, self.step)
        starts = start_of(self.field, self.most)
        return [x - z for x, z in zip(ends, starts, strict=True)]

    @cached_property
    def _moves(self) -> list[tuple[str, Series]]:
        return moves_of(self.field, self.step)

    def _constant(self, x: Poly) -> Series:
        return Series.from_coefficients(self.field.ring, [x], self.most)


def taylor_coefficients(formula: sympy.Expr, most: int) -> list[sympy.Expr]:
    """Return the Taylor coefficients in h of a formula at h = 0, up to h^most."""
    h, derivative, result = symbol("h"), formula, []
    for n in range(most + 1):
        result.append(derivative.subs(h, 0) / math.factorial(n))
        derivative = derivative.diff(h)
    return result


def series_values(step_map: StepMap, structure: Structure, most: int) -> SeriesValues:
    """Return the step's values up to h^most, in a ring that has the structure's formulas.

    Raises LimitError for a map that is not smooth in h at h = 0.
    """
    formulas = _formulas(structure, most)
    field, state = _series(step_map, most)
    if not isinstance(structure, Reversible):
        in_ring = {x: _element(field, step_map, x) for x in formulas}
        elements = {x: y for x, y in in_ring.items() if y is not None}
        if len(elements) == len(in_ring):
            operations = step_map.step if step_map.expand is None else None
            return SeriesValues(field, state, elements, operations=operations)
    return _in_a_new_ring(step_map.hamiltonian, structure, (field, state), formulas)


def _series(step_map: StepMap, most: int) -> tuple[PlainField, State]:
    series = step_map.series(most)
    if series is not None:
        return series
    field, rows, _ = closed_series_of(step_map).in_one_field(step_map.hamiltonian, most)
    return field, tuple(Series(field.ring, tuple(row)) for row in rows)


def _formulas(structure: Structure, most: int) -> list[sympy.Expr]:
    """Return the formulas whose elements are needed; a factor's are its Taylor coefficients."""
    if not isinstance(structure, Conformal):
        return list(structure.formulas)
    return [*structure.entries.values(), *taylor_coefficients(structure.factor, most)]


def _element(field: PlainField, step_map: StepMap, formula: sympy.Expr) -> Poly | None:
    """Return a formula as an element of the field's ring; None if the ring may not have it."""
    if isinstance(field, CanonicalField) and formula == step_map.hamiltonian.exact:
        return field.energy
    return polynomial_element(field.ring, formula)


def polynomial_element(ring: Ring, x: sympy.Expr) -> Poly | None:
    """Return a polynomial in the ring's variables as its element; None for another expression."""
    if x.is_Rational:
        return ring.constant(Fraction(int(x.p), int(x.q)))
    if x.is_Symbol:
        return ring.variable(x.name) if x.name in ring.places else None
    parts = [polynomial_element(ring, y) for y in x.args[:1] if x.is_Pow and x.exp.is_Integer]
    if x.is_Pow and parts and parts[0] is not None and x.exp >= 0:
        return ring.reduce(parts[0] ** int(x.exp))
    if not (x.is_Add or x.is_Mul):
        return None
    total = ring.zero if x.is_Add else ring.one
    for y in x.args:
        part = polynomial_element(ring, y)
        if part is None:
            return None
        total = total + part if x.is_Add else ring.multiply(total, part)
    return total


def _in_a_new_ring(
    hamiltonian: Hamiltonian,
    structure: Structure,
    series: tuple[PlainField, State],
    formulas: Sequence[sympy.Expr],
) -> SeriesValues:
    """Return the values in a ring made for the coefficients of z' and for the formulas."""
    field, state = series
    expressions = [[field.ring.expression(c) for c in x.coefficients] for x in state]
    turned: list[sympy.Expr] = []
    if isinstance(structure, Reversible):
        rows = turned_rows(expressions, hamiltonian.coordinates, structure.reflection)
        turned = [x for row in rows for x in row]
    flat = [x for row in expressions for x in row]
    field, elements = field_of(hamiltonian, *flat, *turned, *formulas)
    width, size = state[0].most + 1, len(flat) + len(turned)
    rows_of = [Series(field.ring, tuple(elements[k : k + width])) for k in range(0, size, width)]
    in_ring = dict(zip(formulas, elements[size:], strict=True))
    return SeriesValues(field, tuple(rows_of[: len(state)]), in_ring, rows_of[len(state) :])


def turned_rows(
    rows: Sequence[Sequence[sympy.Expr]], names: Sequence[str], reflection: Sequence[sympy.Expr]
) -> list[list[sympy.Expr]]:
    """Return the coefficients of ρ∘Φ_h∘ρ in powers of h, from those of Φ_h; ρ is a reflection.

    Raises InputError if ρ is not affine: then powers of h are not turned one by one.
    """
    images = {symbol(n): x for n, x in zip(names, reflection, strict=True)}
    origin = {symbol(n): sympy.S.Zero for n in names}
    count = len(rows[0])
    result = []
    for x in reflection:
        slopes = [x.diff(symbol(n)) for n in names]
        if any(slope.free_symbols & origin.keys() for slope in slopes):
            raise InputError("--reverses", str(x), "is not affine; allowed: a + Σ c_i z_i")
        row = [
            sympy.Add(*(s * y[k].xreplace(images) for s, y in zip(slopes, rows, strict=True)))
            for k in range(count)
        ]
        row[0] += x.xreplace(origin)
        result.append(row)
    return result


@dataclass(frozen=True)
class Element:
    """An element of a ring, in normal form after each product: else the terms become too many."""

    ring: Ring
    value: Poly

    def __add__(self, other: Element) -> Element:
        return Element(self.ring, self.value + other.value)

    def __sub__(self, other: Element) -> Element:
        return Element(self.ring, self.value - other.value)

    def __mul__(self, other: Element | int) -> Element:
        factor = other.value if isinstance(other, Element) else self.ring.one * other
        return Element(self.ring, self.ring.multiply(self.value, factor))


@dataclass(frozen=True)
class ClosedValues:
    """The values as elements of a ring with h, for a map that is written out."""

    ring: Ring
    names: tuple[str, ...]
    step: tuple[Poly, ...]
    elements: Mapping[tuple[str, sympy.Expr], Poly]
    returned: tuple[Poly, ...]

    def number(self, x: Fraction) -> Element:
        return Element(self.ring, self.ring.constant(x))

    def before(self, formula: sympy.Expr) -> Element:
        return Element(self.ring, self.elements["before", formula])

    def after(self, formula: sympy.Expr) -> Element:
        return Element(self.ring, self.elements["after", formula])

    def factor(self, formula: sympy.Expr) -> Element:
        return self.before(formula)

    @cached_property
    def jacobian(self) -> list[list[Element]]:
        diff = self.ring.diff
        return [[Element(self.ring, diff(x, name)) for name in self.names] for x in self.step]

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> list[Element]:
        starts = map(self.ring.variable, self.names)
        return [Element(self.ring, x - z) for x, z in zip(self.returned, starts, strict=True)]


def closed_values(step_map: StepMap, structure: Structure) -> ClosedValues | None:
    """Return the step's values in a ring with h; None if the map is not written out, or is long."""
    closed = write_out(step_map)
    if closed is None or closed.length > _MOST_WRITTEN:
        return None
    hamiltonian, names = step_map.hamiltonian, step_map.hamiltonian.coordinates
    ends = [closed.ring.expression(x) for x in closed.elements]
    h, t = symbol("h"), symbol("t")
    images = {symbol(n): x for n, x in zip(names, ends, strict=True)}
    later = {t: t + h} if hamiltonian.time_dependent else {}
    formulas = list(dict.fromkeys(structure.formulas))
    after = [x.xreplace({**images, **later}) for x in formulas]
    returned = _return_expressions(structure, names, ends, {**images, **later})
    count = [len(ends), len(formulas), len(after)]
    try:
        variables = (*names, "h", *(("t",) if later else ()), *hamiltonian.symbols)
        extra = {s.name for x in formulas for s in x.free_symbols}.difference(variables)
        everything = [*ends, *formulas, *after, *returned]
        ring, elements = embed(everything, (*variables, *sorted(extra)), MAX_TERMS)
    except InputError:
        return None
    parts, start = [], 0
    for n in (*count, len(returned)):
        parts.append(elements[start : start + n])
        start += n
    in_ring = {("before", x): y for x, y in zip(formulas, parts[1], strict=True)}
    in_ring |= {("after", x): y for x, y in zip(formulas, parts[2], strict=True)}
    return ClosedValues(ring, names, tuple(parts[0]), in_ring, tuple(parts[3]))


def _return_expressions(
    structure: Structure,
    names: Sequence[str],
    ends: Sequence[sympy.Expr],
    images: Mapping[sympy.Expr, sympy.Expr],
) -> list[sympy.Expr]:
    """Return Ψ(z') by coordinates, for a structure that asks for it; Ψ is Φ_(−h) or ρ∘Φ_h∘ρ."""
    if isinstance(structure, Symmetric):
        h = symbol("h")
        # One substitution at once: h is −h in the step back, and h in z'.
        return [x.subs({h: -h}, simultaneous=True).xreplace(images) for x in ends]
    if not isinstance(structure, Reversible):
        return []
    symbols = [symbol(n) for n in names]
    turned = [x.xreplace(dict(images)) for x in structure.reflection]
    again = [x.xreplace(dict(zip(symbols, turned, strict=True))) for x in ends]
    return [x.xreplace(dict(zip(symbols, again, strict=True))) for x in structure.reflection]
