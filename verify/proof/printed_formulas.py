"""A user's formulas with decimals of eight digits and more, which stand for numbers near them.

`p_next = p - 0.20833333333333*h**3*q; …`, taken exactly, loses its order by what the digits leave.
So each such decimal becomes a variable. What of hⁿ in z' differs from the exact flow is then a
polynomial in these, for each monomial of what else stands there; where exact numbers near the
printed ones make all of them 0, as `verify.schemes.printed.judged` says, the map has the order with
them. That none near them do so is said where a ball that holds the difference at a point for all
numbers within ten units of the last digits leaves 0 out.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from itertools import islice
from typing import TypeAlias

import sympy

from verify.algebra.enclosure import enclose_over, points
from verify.algebra.identities.polynomials import by_monomials
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, around, middle_and_radius, rational_ball
from verify.arithmetic.exact import decimal, rational
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number import E
from verify.effort import limited
from verify.errors import InputError, LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import AnySeries, series_of
from verify.prose import Formula, Prose, prose
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.maps.by_formulas import map_by_formulas
from verify.schemes.printed.asked import BITS, Asked, Named, ball_of
from verify.schemes.printed.judged import WITHIN, Judged, judge
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.nearby_order import highest
from verify.schemes.printed.printed_numbers import PrintedNumbers, power
from verify.schemes.printed.sentences import of_printed

_MOST_NUMBERS, _MOST_CONDITIONS = 24, 600
MOST_ORDER = 8  # that is looked at where no other is asked for
_POINTS = 8
_DIGITS = 12  # of a residue

Elements: TypeAlias = tuple[Ring, list[Poly]]
Polynomial: TypeAlias = tuple[tuple[Fraction, tuple[int, ...]], ...]  # coefficients and exponents
Formulas: TypeAlias = tuple[tuple[str, str], ...]  # p_next, q_next and what they are


@lru_cache(maxsize=16)
def nearby_of_formulas(formulas: Formulas, hamiltonian: Hamiltonian) -> NearbyOrder | None:
    """The highest order that the map has with exact numbers near those printed in its formulas;
    None where they print none, or none near them is seen to make it a scheme."""
    return _looked_for(formulas, hamiltonian, lambda series, n: series.differences(n))


@lru_cache(maxsize=16)
def nearby_defect(
    formulas: Formulas, hamiltonian: Hamiltonian, most: int = MOST_ORDER
) -> NearbyOrder | None:
    """The same of S = JᵀΩJ − Ω: up to which power of h, `most` at most, it has no term with such
    numbers."""
    return _looked_for(formulas, hamiltonian, _defects, most)


def _defects(series: AnySeries, n: int) -> Elements:
    """Of hⁿ in S."""
    form = series.form(n)
    return form.ring, list(form.entries.values())


def moved_by_units(formulas: Formulas, hamiltonian: Hamiltonian) -> list[Formulas]:
    """The formulas with one printed number after the other moved by a unit of its last digit."""
    read = _read(dict(formulas), hamiltonian)
    if not read.readings:
        return []
    first = read.readings[0]
    return [read.at({name: first.values[name] + unit}) for name, unit in first.units.items()]


def told_defect(near: NearbyOrder, form: str) -> Prose:
    """Of which coefficients ΔJ or S has no term; `form`: which of them it is."""
    power = Formula(f"h^{near.order}")
    return prose(
        f"{form} has no term up to ", power, " with exact coefficients near the printed ones: ",
        near.said,
    )  # fmt: skip


def _looked_for(
    formulas: Formulas,
    hamiltonian: Hamiltonian,
    elements: Callable[[AnySeries, int], Elements],
    most: int = MOST_ORDER,
) -> NearbyOrder | None:
    try:
        with limited("scheme", formulas, "to look for exact numbers near the printed ones"):
            read = _read(dict(formulas), hamiltonian)
            if not read.readings or len(read.numbers) > _MOST_NUMBERS:
                return None
            named = map_by_formulas(hamiltonian, read.named, tuple(read.numbers))
            printed = _PrintedMap(tuple(read.numbers), read.readings)
            return printed.order(partial(elements, series_of(named, 2)), most)
    except InputError:  # no polynomial in its decimals, or too long
        return None


@dataclass(frozen=True)
class _ReadFormulas:
    """`named`: the formulas with a name for each long decimal, `numbers` these as they are printed;
    `readings`: the ways in which they may be read, the first before others; none without any."""

    named: Mapping[str, str]
    numbers: Mapping[str, str]
    readings: tuple[PrintedNumbers, ...]

    def at(self, values: Mapping[str, Fraction]) -> Formulas:
        """The formulas with these values, and the other numbers as they are printed."""
        texts = {**self.numbers, **{name: str(x) for name, x in values.items()}}
        pattern = re.compile(rf"\b({'|'.join(map(re.escape, texts))})\b")
        written = {x: pattern.sub(lambda m: f"({texts[m[0]]})", y) for x, y in self.named.items()}
        return tuple(written.items())


def _read(formulas: Mapping[str, str], hamiltonian: Hamiltonian) -> _ReadFormulas:
    naming, label = Naming({}), "number"
    while any(name.startswith(label) for name in hamiltonian.parameters):
        label += "_"
    named = {
        left: naming.entry(right, f"{label}{k}") for k, (left, right) in enumerate(formulas.items())
    }
    # What H has too is a parameter, and exact.
    parameters = {abs(x) for x in hamiltonian.exact.atoms(sympy.Rational)}
    numbers = {name: _exact_or_printed(text, parameters) for name, text in naming.numbers.items()}
    readings = tuple(x for x in PrintedNumbers(numbers).of_a_method() if x.units)
    return _ReadFormulas(named, numbers, readings)


def _exact_or_printed(text: str, parameters: set[sympy.Rational]) -> str:
    if "/" in text:
        return text
    value = rational(text)
    # In brackets, as a long quotient may be read as another rounded number.
    return f"({value})" if abs(sympy.sympify(value)) in parameters else text


@dataclass(frozen=True)
class _PrintedMap:
    """A map over a ring in which the printed numbers are variables, called `names`; `readings`:
    the ways in which they may be read, that taken first before others."""

    names: tuple[str, ...]
    readings: tuple[PrintedNumbers, ...]

    def order(self, elements: Callable[[int], Elements], most: int) -> NearbyOrder | None:
        """Up to which power of h, `most` at most, the elements are 0 with numbers near the printed
        ones."""
        conditions = _Conditions(self.names, elements)
        best, _ = highest(self.readings, most, conditions.judge)
        if best is None:
            return None
        order, numbers, found = best
        verdict, said, _ = of_printed(found, order)
        beyond = self._excluded(order + 1, numbers, elements) if order < most else None
        return NearbyOrder(order, verdict, said, beyond, ())

    def _excluded(
        self, n: int, numbers: PrintedNumbers, elements: Callable[[int], Elements]
    ) -> Condition | None:
        """One of hⁿ that is not 0 whatever numbers near the printed ones are taken, shown at a
        point; None where none is seen."""
        ring, looked_at = elements(n)
        others = [name for name in ring.variables if name not in self.names]
        for point in islice(points(others), _POINTS):
            with working_precision(BITS):
                at = {name: rational_ball(value) for name, value in point.items()}
                box = at | self._box(numbers)
                for x in looked_at:
                    found = enclose_over(ring, x, box)
                    if found is not None and not found.contains(0):
                        size = decimal(middle_and_radius(found)[0], _DIGITS)
                        return Condition(f"the coefficient of h^{n} = 0", n, size, False)
        return None

    def _box(self, numbers: PrintedNumbers) -> dict[str, Ball]:
        """All values near the printed ones, in balls."""
        exact = {
            name: ball_of(numbers.entry(name)) for name in self.names if name not in numbers.units
        }
        units = numbers.units.items()
        return exact | {name: around(numbers.values[name], WITHIN * unit) for name, unit in units}


class _Conditions:
    """What has to be 0 of each power of h: polynomials in the printed numbers."""

    def __init__(self, names: tuple[str, ...], elements: Callable[[int], Elements]) -> None:
        self.names, self.elements = names, elements
        self._made: list[list[Polynomial]] = []

    def judge(self, numbers: PrintedNumbers, order: int) -> Judged:
        """Whether numbers near the printed ones make all of them 0 up to h^order."""
        while len(self._made) <= order:
            self._made.append(self._of_power(len(self._made)))
        rows = [(n, x) for n, made in enumerate(self._made[: order + 1]) for x in made]
        if len(rows) > _MOST_CONDITIONS:
            raise LimitError("scheme", len(rows), "are more conditions than are looked at")
        equations = tuple(Named(f"{k + 1}. term of h^{n}", max(n, 1))
                          for k, (n, _) in enumerate(rows))  # fmt: skip
        entries = tuple(numbers.entry(name) for name in self.names)
        residues = partial(_residues, [x for _, x in rows])
        return judge(numbers, Asked(entries, equations, residues), order)

    def _of_power(self, n: int) -> list[Polynomial]:
        ring, elements = self.elements(n)
        return [x for element in elements for x in _by_monomials(ring, element, self.names)]


def _by_monomials(ring: Ring, x: Poly, names: Sequence[str]) -> list[Polynomial]:
    """The coefficient of each monomial of all else, as a polynomial in the names; LimitError where
    a function of one of them stands in it."""
    places = [ring.places.get(name) for name in names]  # None of one that it does not hold
    for name, place in zip(names, places, strict=True):
        if place is not None and ring.diff(x, name) != ring.reduce(x.derivative(place)):
            raise LimitError("scheme", name, "stands within a function")
    others = {place for place in range(len(x.degrees())) if place not in places}
    return [
        tuple(
            (Fraction(int(c.p), int(c.q)), tuple(0 if k is None else own[k] for k in places))
            for own, c in part.items()
        )
        for part in by_monomials(x, others).values()
    ]


def _residues(
    rows: Sequence[Polynomial], entries: Sequence[E], one: E, bound: bool = False
) -> list[E]:
    return [_value(row, entries, one, bound) for row in rows]


def _value(row: Polynomial, entries: Sequence[E], one: E, bound: bool) -> E:
    total = one * 0
    for number, powers in row:
        size = abs(number) if bound else number
        term = one * size.numerator / size.denominator
        for x, n in zip(entries, powers, strict=True):
            term = term * power(x, n) if n else term
        total = total + term
    return total
