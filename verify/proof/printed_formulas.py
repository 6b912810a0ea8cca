"""A user's formulas with decimals of eight digits and more, which stand for numbers near them.

`p_next = p - 0.20833333333333*h**3*q; …`, taken exactly, has a lower order than meant, since its
digits are rounded. So each such decimal becomes a variable. The difference from the exact flow at
hⁿ is a polynomial in all other variables, whose coefficients are polynomials in these. If exact
numbers near the printed ones make all coefficients 0, as `verify.schemes.printed.judgement`
decides, the map has the order with these numbers. The order is shown to end at hⁿ if, at some
point, an enclosure of the difference for all numbers within ten units of the last digits excludes
0.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from itertools import islice
from typing import TypeAlias

import sympy

from verify.algebra.enclosure import enclose_over, points
from verify.algebra.identities.polynomials import split_by_monomials
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import Ball, make_ball, midpoint_and_radius, rational_ball
from verify.arithmetic.exact import decimal, rational
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import E
from verify.effort import limit_effort
from verify.errors import InputError, LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import AnySeries, series_of
from verify.prose import Formula, Prose, prose
from verify.schemes.conditions.condition import Condition, NearbyOrder
from verify.schemes.maps.formula_map import step_map_from_formulas
from verify.schemes.maps.step_map import StepMap
from verify.schemes.printed.condition_set import BITS, ConditionSet, NamedEquation, ball_of
from verify.schemes.printed.judgement import WITHIN, Judgement, judge
from verify.schemes.printed.naming import Naming
from verify.schemes.printed.nearby_order import find_highest_order
from verify.schemes.printed.printed_numbers import PrintedNumbers, power
from verify.schemes.printed.sentences import ruling_on_order

_MOST_NUMBERS, _MOST_CONDITIONS = 24, 600
MOST_ORDER = 8  # the highest power of h examined by default
_TESTED_POINTS = 8
_RESIDUE_DIGITS = 12

Elements: TypeAlias = tuple[Ring, list[Poly]]
Polynomial: TypeAlias = tuple[tuple[Fraction, tuple[int, ...]], ...]  # coefficients and exponents
Formulas: TypeAlias = tuple[tuple[str, str], ...]  # pairs such as ("p_next", its formula)


@lru_cache(maxsize=16)
def nearby_of_formulas(formulas: Formulas, hamiltonian: Hamiltonian) -> NearbyOrder | None:
    """Return the highest order of the map with exact numbers near those printed in its formulas.

    None if they print none, or if no numbers near them are seen to give the order 1.
    """
    return _highest_order(formulas, hamiltonian, lambda series, n: series.differences(n))


@lru_cache(maxsize=16)
def nearby_defect(
    formulas: Formulas, hamiltonian: Hamiltonian, most: int = MOST_ORDER
) -> NearbyOrder | None:
    """Return the power of h, at most `most`, up to which S = JᵀΩJ − Ω has no term.

    The numbers are exact ones near those printed in the formulas; None as `nearby_of_formulas`.
    """
    return _highest_order(formulas, hamiltonian, _defects, most)


def _defects(series: AnySeries, n: int) -> Elements:
    """Return the entries of the coefficient of hⁿ in S, with their ring."""
    form = series.form(n)
    return form.ring, list(form.entries.values())


def formulas_moved_by_units(formulas: Formulas, hamiltonian: Hamiltonian) -> list[Formulas]:
    """Return the formulas, with each printed number in turn moved by a unit of its last digit."""
    parsed = _read(dict(formulas), hamiltonian)
    if not parsed.readings:
        return []
    first = parsed.readings[0]
    return [
        parsed.with_values({name: first.values[name] + unit}) for name, unit in first.units.items()
    ]


def named_maps(
    formulas: Formulas, hamiltonian: Hamiltonian
) -> Iterator[tuple[StepMap, "PrintedMap"]]:
    """Yield the map of the formulas, with variables for its decimals, by each reading of these."""
    parsed = _read(dict(formulas), hamiltonian)
    names = tuple(parsed.numbers)
    if parsed.readings:
        step_map = step_map_from_formulas(hamiltonian, parsed.with_names, names)
        yield from ((step_map, PrintedMap(names, (x,))) for x in parsed.readings)


def describe_nearby_defect(near: NearbyOrder, form: str) -> Prose:
    """State the power of h up to which `form`, ΔJ or S, has no term with exact coefficients."""
    power = Formula(f"h^{near.order}")
    return prose(
        f"{form} has no term up to ", power, " with exact coefficients near the printed ones: ",
        near.explanation,
    )  # fmt: skip


def _highest_order(
    formulas: Formulas,
    hamiltonian: Hamiltonian,
    elements: Callable[[AnySeries, int], Elements],
    most: int = MOST_ORDER,
) -> NearbyOrder | None:
    try:
        with limit_effort("scheme", formulas, "to look for exact numbers near the printed ones"):
            parsed = _read(dict(formulas), hamiltonian)
            if not parsed.readings or len(parsed.numbers) > _MOST_NUMBERS:
                return None
            step_map = step_map_from_formulas(hamiltonian, parsed.with_names, tuple(parsed.numbers))
            printed = PrintedMap(tuple(parsed.numbers), parsed.readings)
            return printed.order(partial(elements, series_of(step_map, 2)), most)
    except InputError:  # the map is no polynomial in its decimals, or too long
        return None


@dataclass(frozen=True)
class _NamedFormulas:
    """A user's formulas with names for the long decimals.

    `with_names`: the formulas with a name in place of each long decimal. `numbers`: these decimals
    as printed. `readings`: the readings of the decimals, the preferred one first; empty without
    decimals.
    """

    with_names: Mapping[str, str]
    numbers: Mapping[str, str]
    readings: tuple[PrintedNumbers, ...]

    def with_values(self, values: Mapping[str, Fraction]) -> Formulas:
        """Return the formulas with these values, and the other numbers as they are printed."""
        texts = {**self.numbers, **{name: str(x) for name, x in values.items()}}
        pattern = re.compile(rf"\b({'|'.join(map(re.escape, texts))})\b")
        formulas = {
            x: pattern.sub(lambda m: f"({texts[m[0]]})", y) for x, y in self.with_names.items()
        }
        return tuple(formulas.items())


def _read(formulas: Mapping[str, str], hamiltonian: Hamiltonian) -> _NamedFormulas:
    # The names of the decimals must not be parameters of H.
    naming, label = Naming({}), "number"
    while any(name.startswith(label) for name in hamiltonian.parameters):
        label += "_"
    formulas_with_names = {
        side: naming.entry(right, f"{label}{k}") for k, (side, right) in enumerate(formulas.items())
    }
    # A number that occurs in H as well is a parameter, and exact.
    parameters = {abs(x) for x in hamiltonian.exact.atoms(sympy.Rational)}
    numbers = {name: _exact_or_printed(text, parameters) for name, text in naming.numbers.items()}
    readings = tuple(x for x in PrintedNumbers(numbers).of_a_method() if x.units)
    return _NamedFormulas(formulas_with_names, numbers, readings)


def _exact_or_printed(text: str, parameters: set[sympy.Rational]) -> str:
    if "/" in text:
        return text
    value = rational(text)
    # The brackets keep a long quotient from being read as a rounded number.
    return f"({value})" if abs(sympy.sympify(value)) in parameters else text


@dataclass(frozen=True)
class PrintedMap:
    """A map over a ring in which the printed numbers are variables, called `names`.

    `readings`: the readings of the numbers, the preferred one first.
    """

    names: tuple[str, ...]
    readings: tuple[PrintedNumbers, ...]

    def order(self, elements: Callable[[int], Elements], most: int) -> NearbyOrder | None:
        """Return the highest power of h up to which exact numbers make all elements 0.

        The numbers are near the printed ones. `most`: the last power examined.
        """
        # The conditions are polynomials in the printed numbers, the same for every reading.
        conditions = _Conditions(self.names, elements)
        best, _ = find_highest_order(self.readings, most, conditions.judge)
        if best is None:
            return None
        order, numbers, judgement = best
        verdict, sentence, _ = ruling_on_order(judgement, order)
        end = self.find_nonzero(order + 1, numbers, elements) if order < most else None
        return NearbyOrder(order, verdict, sentence, end, ())

    def find_nonzero(
        self, n: int, numbers: PrintedNumbers, elements: Callable[[int], Elements]
    ) -> Condition | None:
        """Find an element of hⁿ that is not 0 for any numbers near the printed ones.

        An enclosure at a point shows it; None if no such element is found.
        """
        ring, coefficients = elements(n)
        others = [name for name in ring.variables if name not in self.names]
        for point in islice(points(others), _TESTED_POINTS):
            with working_precision(BITS):
                point_balls = {name: rational_ball(value) for name, value in point.items()}
                box = point_balls | self._box(numbers)
                for x in coefficients:
                    enclosure = enclose_over(ring, x, box)
                    if enclosure is not None and not enclosure.contains(0):
                        size = decimal(midpoint_and_radius(enclosure)[0], _RESIDUE_DIGITS)
                        return Condition(f"the coefficient of h^{n} = 0", n, size, False)
        return None

    def _box(self, numbers: PrintedNumbers) -> dict[str, Ball]:
        """Return balls that contain all numbers within ten units of the printed ones."""
        exact = {
            name: ball_of(numbers.entry(name)) for name in self.names if name not in numbers.units
        }
        units = numbers.units.items()
        return exact | {
            name: make_ball(numbers.values[name], WITHIN * unit) for name, unit in units
        }


class _Conditions:
    """The conditions at each power of h: polynomials in the numbers that must be 0."""

    def __init__(self, names: tuple[str, ...], elements: Callable[[int], Elements]) -> None:
        self.names, self.elements = names, elements
        self._cache: list[list[Polynomial]] = []

    def judge(self, numbers: PrintedNumbers, order: int) -> Judgement:
        """Judge whether numbers near the printed ones satisfy all conditions up to h^order."""
        while len(self._cache) <= order:
            self._cache.append(self._of_power(len(self._cache)))
        rows = [
            (n, x) for n, polynomials in enumerate(self._cache[: order + 1]) for x in polynomials
        ]
        if len(rows) > _MOST_CONDITIONS:
            raise LimitError("scheme", len(rows), "are more conditions than are looked at")
        equations = tuple(NamedEquation(f"{k + 1}. term of h^{n}", max(n, 1))
                          for k, (n, _) in enumerate(rows))  # fmt: skip
        entries = tuple(numbers.entry(name) for name in self.names)
        residues = partial(_residues, [x for _, x in rows])
        return judge(numbers, ConditionSet(entries, equations, residues), order)

    def _of_power(self, n: int) -> list[Polynomial]:
        ring, elements = self.elements(n)
        return [x for element in elements for x in _by_monomials(ring, element, self.names)]


def _by_monomials(ring: Ring, x: Poly, names: Sequence[str]) -> list[Polynomial]:
    """Return for each monomial in the other variables its coefficient, a polynomial in `names`.

    Raises LimitError if one of the names occurs within a function.
    """
    indices = [ring.places.get(name) for name in names]  # None for a name that the ring lacks
    for name, index in zip(names, indices, strict=True):
        # The ring's derivative applies the chain rule, the polynomial's does not: they differ if
        # the name occurs within a function.
        if index is not None and ring.diff(x, name) != ring.reduce(x.derivative(index)):
            raise LimitError("scheme", name, "stands within a function")
    other_indices = {index for index in range(len(x.degrees())) if index not in indices}
    return [
        tuple(
            (Fraction(int(c.p), int(c.q)), tuple(0 if k is None else exponents[k] for k in indices))
            for exponents, c in part.items()
        )
        for part in split_by_monomials(x, other_indices).values()
    ]


def _residues(
    rows: Sequence[Polynomial], entries: Sequence[E], one: E, bound: bool = False
) -> list[E]:
    return [_value(row, entries, one, bound) for row in rows]


def _value(row: Polynomial, entries: Sequence[E], one: E, bound: bool) -> E:
    total = one * 0
    for number, powers in row:
        # A bound takes the absolute value of every coefficient.
        size = abs(number) if bound else number
        term = one * size.numerator / size.denominator
        for x, n in zip(entries, powers, strict=True):
            term = term * power(x, n) if n else term
        total = total + term
    return total
