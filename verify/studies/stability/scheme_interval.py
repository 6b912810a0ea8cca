"""The stability interval of a named scheme; for printed coefficients that of exact ones near them.

M is the matrix of a step on the harmonic oscillator, a function of y = hω. The longest intervals
that a splitting can have contain points y at which |tr M| touches 2 and M = ±I, so that both
entries off the diagonal vanish. With rounded coefficients each such point becomes a gap, about as
narrow as their last digits. `verify.schemes.printed.solutions` looks for coefficients near the
printed ones with M = ±I in each gap, which satisfy the order conditions too. The end of the
interval is returned to the digits that the coefficients determine.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import E
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.printed_formulas import formulas_moved_by_units, nearby_defect
from verify.prose import Number, Prose, prose
from verify.schemes import get
from verify.schemes.maps.formula_map import step_map_from_formulas
from verify.schemes.printed.condition_set import BITS, ConditionSet, NamedEquation
from verify.schemes.printed.judgement import WITHIN
from verify.schemes.printed.nearby_order import PrintedParts, parts_at
from verify.schemes.printed.neighbourhood import AnyNumbers, Neighbourhood
from verify.schemes.printed.solutions import NearbySolution, nearest
from verify.schemes.printed.splitting_table import PrintedTable
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting
from verify.studies.stability.linear_stability import LinearStability, NearbyLimit, stability_of_map

_NARROW = Fraction(1, 1000)  # relative to y: a wider gap ends the interval, a narrower may close
_GAP_UNIT = Fraction(1, 64)  # a gap's y is free to move by this, as a coefficient by its last unit
_DIGITS = 40
_DIGITS_NOTE = prose("to the digits that the coefficients leave")
_EXTRA_ORDERS = 2  # order conditions beyond the claimed order are solved together with the gaps


def linear_stability(name: str) -> LinearStability:
    """Return the stability interval in hω of the scheme of that name.

    Raises InputError for a scheme that has no closed form on the harmonic oscillator.
    """
    scheme = get(name)
    stability = _stability_of_scheme(scheme)
    if scheme.formulas:
        return _stability_of_formulas(scheme, stability)
    sizes = getattr(scheme.every_h, "nearby", None)
    if not isinstance(sizes, PrintedParts) or stability.interval in (sympy.oo, 0):
        return stability
    limits = (_find_limit(scheme, stability, sizes, table) for table in sizes.tables)
    first = sizes.tables[0]
    whole = first.printed.values
    limit = next(filter(None, limits), None) or _limit_with_radius(
        first, whole, _DIGITS_NOTE, Fraction(0)
    )
    return stability if limit is None else replace(stability, interval=limit)


def _oscillator() -> Hamiltonian:
    return systems.get("harmonic").hamiltonian({"omega": 1})


def _stability_of_scheme(scheme: Scheme, narrow: Fraction = Fraction(0)) -> LinearStability:
    return stability_of_map(scheme.name, scheme.step_map(_oscillator()), narrow)


def _stability_of_formulas(scheme: Scheme, stability: LinearStability) -> LinearStability:
    """Return the interval to the digits that the decimals in a user's formulas determine.

    It is returned unchanged if no exact numbers near the decimals make det M = 1.
    """
    oscillator, formulas = _oscillator(), tuple(scheme.formulas.items())
    neighbours = formulas_moved_by_units(formulas, oscillator)
    degree = scheme.step_map(oscillator).flat.degree
    if not neighbours or not degree:
        return stability
    nearby = nearby_defect(formulas, oscillator, degree)
    if nearby is None or nearby.order < degree:
        return stability
    ends = [_end_of_formulas(dict(formula_set)) for formula_set in (formulas, *neighbours)]
    values = [x for x in ends if x is not None]
    if len(values) < len(ends):
        return stability
    # First order in each decimal: the sum of the changes by one unit each.
    radius = sum((abs(x - values[0]) for x in values), Fraction(1, 10 ** (_DIGITS - 2)))
    note = (
        _DIGITS_NOTE
        if stability.delta_j == 0
        else prose("det M = 1 with exact numbers near the printed ones: ", nearby.explanation)
    )
    return replace(stability, interval=NearbyLimit(values[0], radius, note))


def _end_of_formulas(formulas: Mapping[str, str]) -> Fraction | None:
    step = step_map_from_formulas(_oscillator(), formulas)
    stability = stability_of_map("printed", step, _NARROW, keeps_area=True)
    return None if stability.interval in (sympy.oo, 0) else Fraction(stability.decimal(_DIGITS))


def _find_limit(
    scheme: Scheme, stability: LinearStability, sizes: PrintedParts, table: PrintedTable
) -> NearbyLimit | None:
    """Return the end for exact coefficients; None if none near the printed ones close the gaps."""
    # In a gap narrower than `_NARROW` |tr M| may only touch 2 with exact coefficients.
    nearby_order = sizes(scheme.order + _EXTRA_ORDERS)
    gaps = _stability_of_scheme(scheme, _NARROW).gaps
    nearby = _close_gaps(table, nearby_order.order if nearby_order else 0, gaps)
    if nearby is None or nearby.distance > WITHIN:
        return None
    note = prose(
        f"exact coefficients within {float(nearby.distance):.2g} units of the last digits close "
        "gaps of those printed, of which the first is at hω = ", Number(stability.decimal(12)),
    )  # fmt: skip
    return _limit_with_radius(table, nearby.numbers, note if gaps else _DIGITS_NOTE)


def _limit_with_radius(
    table: PrintedTable, numbers: Mapping[str, Fraction], note: Prose, narrow: Fraction = _NARROW
) -> NearbyLimit | None:
    """Return the end, with a radius from changes of each number by a unit of its last digit."""
    value, radius = _find_end(table, numbers, narrow), Fraction(1, 10 ** (_DIGITS - 2))
    if value is None:
        return None
    for name, unit in table.printed.units.items():
        moved_end = _find_end(table, {**numbers, name: numbers[name] + unit}, narrow)
        if moved_end is None:
            return None
        radius += abs(moved_end - value)
    return NearbyLimit(value, radius, note)


def _find_end(
    table: PrintedTable, numbers: Mapping[str, Fraction], narrow: Fraction
) -> Fraction | None:
    parts = parts_at(table, numbers)
    scheme = splitting("printed", parts, order=1, symmetric=False, source="")
    stability = _stability_of_scheme(scheme, narrow)
    return None if stability.interval in (sympy.oo, 0) else Fraction(stability.decimal(_DIGITS))


def _close_gaps(table: PrintedTable, order: int, gaps: Sequence[Fraction]) -> NearbySolution | None:
    """Find numbers near the printed ones that have the order, with M = ±I in each gap."""
    names = [f"y_{k}" for k in range(len(gaps))]
    # The gaps' y are unknowns too, each with `_GAP_UNIT` as its unit.
    free = dict.fromkeys(names, _GAP_UNIT)
    texts = {name: decimal(y, 12) for name, y in zip(names, gaps, strict=True)}
    numbers = AnyNumbers(
        {**table.printed.numbers, **texts},
        {**table.printed.values, **dict(zip(names, gaps, strict=True))},
        {**table.printed.units, **free},
    )
    conditions, count = table.condition_set(max(order, 1)), len(table.sizes)
    indices = conditions.up_to(order)

    def residuals(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        values = conditions.residuals(entries[:count], one, bound)
        off = (_off_diagonal(table, entries[:count], y, one, bound) for y in entries[count:])
        return [*(values[k] for k in indices), *(x for pair in off for x in pair)]

    equations = [conditions.equations[k] for k in indices]
    equations += [NamedEquation(f"{x} = 0 at {name}", 1) for name in names for x in "bc"]
    entries = (*table.sizes, *map(symbol, names))
    with working_precision(BITS):
        nearby = Neighbourhood(numbers, ConditionSet(entries, tuple(equations), residuals))
        return nearest(nearby, range(len(equations)))


def _off_diagonal(
    table: PrintedTable, sizes: Sequence[E], y: E, one: E, bound: bool
) -> tuple[E, E]:
    """Return ∂p'/∂q and ∂q'/∂p of a step of size y on the harmonic oscillator.

    `bound`: with all terms positive, as a bound of their sizes.
    """
    # Rows of M: a drift adds size·y of p to q, a kick subtracts size·y of q from p.
    of_p, of_q = (one, one * 0), (one * 0, one)
    for (kind, _), size in zip(table.parts, sizes, strict=True):
        move = size * y
        if kind == "drift":
            of_q = of_q[0] + move * of_p[0], of_q[1] + move * of_p[1]
        else:
            move = move if bound else -move
            of_p = of_p[0] + move * of_q[0], of_p[1] + move * of_q[1]
    return of_p[1], of_q[0]
