"""The stability interval of a scheme by its name; of printed coefficients that of exact ones near.

Where |tr M| touches 2 within the interval, as with the longest intervals that a splitting can have,
rounded coefficients open a gap there that is as narrow as their last digits. In such a gap of exact
ones M = ±I, so that both entries off the diagonal vanish: whether there are coefficients near the
printed ones of which that is so, in each gap and with the conditions of the order, is asked as
`verify.schemes.printed.nearest` asks. An end is told to the digits that the coefficients leave.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import decimal
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number import E
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.printed_formulas import moved_by_units, nearby_defect
from verify.prose import Number, Prose, prose
from verify.schemes import get
from verify.schemes.maps.by_formulas import map_by_formulas
from verify.schemes.printed.asked import BITS, Asked, Named
from verify.schemes.printed.judged import WITHIN
from verify.schemes.printed.nearby import AnyNumbers, Nearby
from verify.schemes.printed.nearby_order import PrintedParts, parts_at
from verify.schemes.printed.nearest import Nearest, nearest
from verify.schemes.printed.splitting_table import PrintedTable
from verify.schemes.scheme import Scheme
from verify.schemes.splitting import splitting
from verify.studies.stability.linear import LinearStability, NearbyLimit, of_map

_NARROW = Fraction(1, 1000)  # a gap that is looked at; whether it closes is asked
_FREE = Fraction(1, 64)  # in place of a unit of y
_DIGITS = 40
_LEFT = prose("to the digits that the coefficients leave")
_BEYOND = 2  # the claimed order, that is asked together with gaps


def linear_stability(name: str) -> LinearStability:
    """The stability interval of the scheme of that name in hω.

    Raises InputError for a scheme that has no closed form on the harmonic oscillator.
    """
    scheme = get(name)
    found = _of_scheme(scheme)
    if scheme.formulas:
        return _of_formulas(scheme, found)
    sizes = getattr(scheme.every_h, "nearby", None)
    if not isinstance(sizes, PrintedParts) or found.interval in (sympy.oo, 0):
        return found
    limits = (_limit(scheme, found, sizes, table) for table in sizes.tables)
    first = sizes.tables[0]
    whole = first.printed.values
    limit = next(filter(None, limits), None) or _known(first, whole, _LEFT, Fraction(0))
    return found if limit is None else replace(found, interval=limit)


def _oscillator() -> Hamiltonian:
    return systems.get("harmonic").hamiltonian({"omega": 1})


def _of_scheme(scheme: Scheme, narrow: Fraction = Fraction(0)) -> LinearStability:
    return of_map(scheme.name, scheme.step_map(_oscillator()), narrow)


def _of_formulas(scheme: Scheme, found: LinearStability) -> LinearStability:
    """To the digits that the decimals in a user's formulas leave, where exact ones near them make
    det M = 1."""
    oscillator, formulas = _oscillator(), tuple(scheme.formulas.items())
    moved, degree = moved_by_units(formulas, oscillator), scheme.step_map(oscillator).flat.degree
    if not moved or not degree:
        return found
    near = nearby_defect(formulas, oscillator, degree)
    if near is None or near.order < degree:
        return found
    ends = [_end_of_formulas(dict(each)) for each in (formulas, *moved)]
    values = [x for x in ends if x is not None]
    if len(values) < len(ends):
        return found
    radius = sum((abs(x - values[0]) for x in values), Fraction(1, 10 ** (_DIGITS - 2)))
    said = (
        _LEFT
        if found.delta_j == 0
        else prose("det M = 1 with exact numbers near the printed ones: ", near.said)
    )
    return replace(found, interval=NearbyLimit(values[0], radius, said))


def _end_of_formulas(formulas: Mapping[str, str]) -> Fraction | None:
    step = map_by_formulas(_oscillator(), formulas)
    found = of_map("printed", step, _NARROW, keeps_area=True)
    return None if found.interval in (sympy.oo, 0) else Fraction(found.decimal(_DIGITS))


def _limit(
    scheme: Scheme, printed: LinearStability, sizes: PrintedParts, table: PrintedTable
) -> NearbyLimit | None:
    """The end for exact coefficients; None where none near the printed ones close the gaps."""
    near, gaps = sizes(scheme.order + _BEYOND), _of_scheme(scheme, _NARROW).gaps
    closed = _closed(table, near.order if near else 0, gaps)
    if closed is None or closed.off > WITHIN:
        return None
    said = prose(
        f"exact coefficients within {float(closed.off):.2g} units of the last digits close gaps of "
        "those printed, of which the first is at hω = ", Number(printed.decimal(12)),
    )  # fmt: skip
    return _known(table, closed.numbers, said if gaps else _LEFT)


def _known(
    table: PrintedTable, numbers: Mapping[str, Fraction], said: Prose, narrow: Fraction = _NARROW
) -> NearbyLimit | None:
    """The end, to what changes of each number by a unit of its last digit leave of it."""
    value, radius = _end(table, numbers, narrow), Fraction(1, 10 ** (_DIGITS - 2))
    if value is None:
        return None
    for name, unit in table.printed.units.items():
        other = _end(table, {**numbers, name: numbers[name] + unit}, narrow)
        if other is None:
            return None
        radius += abs(other - value)
    return NearbyLimit(value, radius, said)


def _end(table: PrintedTable, numbers: Mapping[str, Fraction], narrow: Fraction) -> Fraction | None:
    parts = parts_at(table, numbers)
    scheme = splitting("printed", parts, order=1, symmetric=False, source="")
    found = _of_scheme(scheme, narrow)
    return None if found.interval in (sympy.oo, 0) else Fraction(found.decimal(_DIGITS))


def _closed(table: PrintedTable, order: int, gaps: Sequence[Fraction]) -> Nearest | None:
    """Numbers near the printed ones that have the order, with M = ±I in each gap."""
    names = [f"y_{k}" for k in range(len(gaps))]
    free = dict.fromkeys(names, _FREE)
    texts = {name: decimal(y, 12) for name, y in zip(names, gaps, strict=True)}
    numbers = AnyNumbers(
        {**table.printed.numbers, **texts},
        {**table.printed.values, **dict(zip(names, gaps, strict=True))},
        {**table.printed.units, **free},
    )
    ordered, count = table.asked(max(order, 1)), len(table.sizes)
    own = ordered.up_to(order)

    def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        found = ordered.residues(entries[:count], one, bound)
        off = (_off_diagonal(table, entries[:count], y, one, bound) for y in entries[count:])
        return [*(found[k] for k in own), *(x for pair in off for x in pair)]

    equations = [ordered.equations[k] for k in own]
    equations += [Named(f"{x} = 0 at {name}", 1) for name in names for x in "bc"]
    entries = (*table.sizes, *map(symbol, names))
    with working_precision(BITS):
        near = Nearby(numbers, Asked(entries, tuple(equations), residues))
        return nearest(near, range(len(equations)))


def _off_diagonal(
    table: PrintedTable, sizes: Sequence[E], y: E, one: E, bound: bool
) -> tuple[E, E]:
    """∂p'/∂q and ∂q'/∂p of a step of size y on the harmonic oscillator."""
    of_p, of_q = (one, one * 0), (one * 0, one)
    for (kind, _), size in zip(table.parts, sizes, strict=True):
        move = size * y
        if kind == "drift":
            of_q = of_q[0] + move * of_p[0], of_q[1] + move * of_p[1]
        else:
            move = move if bound else -move
            of_p = of_p[0] + move * of_q[0], of_p[1] + move * of_q[1]
    return of_p[1], of_q[0]
