"""A defect that no rounding of printed coefficients explains.

A scheme's long decimals become variables. The coefficient of hⁿ in the defect is then a polynomial
in these too. If an enclosure of it at some point, for all numbers within ten units of the last
digits, excludes 0, no coefficients that the digits may stand for keep the structure up to hⁿ.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial

from verify.algebra.formula import symbol
from verify.algebra.ring import Decision, Poly, Ring
from verify.effort import MAX_CALLS, answer_unless_long
from verify.errors import InputError
from verify.hamiltonians.canonical_field import field_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.proof.expansion import Leading
from verify.proof.order_conditions import describe_nearby
from verify.proof.printed_formulas import PrintedMap, named_maps
from verify.proof.structures.structure_values import series_values
from verify.prose import Prose, prose, read_prose
from verify.schemes.conditions.condition import NearbyOrder
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.conditions.implicit_tableau import implicit_step
from verify.schemes.conditions.scheme_clocks import conditions_for
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.maps import kind_of
from verify.schemes.maps.step_map import StepMap
from verify.schemes.printed.nearby_order import PrintedParts
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.schemes.scheme import Scheme
from verify.structures import Structure
from verify.verdict import Verdict

_MOST_PLACES = 60  # of a coefficient that is taken for a printed decimal
_MOST_BEYOND = 3  # powers of h looked at, from the first at which a term is expected


@dataclass(frozen=True)
class PrintedJudgement:
    """A verdict on exact coefficients near the printed ones, and what is seen of their defect."""

    verdict: Verdict
    reason: Prose
    leading: Leading


def judge_printed(
    scheme: Scheme,
    hamiltonian: Hamiltonian,
    structure: Structure,
    claimed: int | None,
    near: NearbyOrder | None,
    leading: Leading,
) -> PrintedJudgement | None:
    """Judge a claim that the printed coefficients refute, of the exact ones near them.

    None if the rounding of the printed ones may be the cause. `claimed`: the claimed order of the
    defect; None if it is claimed to vanish. `near`: the order of exact coefficients near them.
    `leading`: the leading coefficient with the printed ones.
    """
    # A map of order r differs from the flow by O(h^(r+1)), and so does all that the flow keeps.
    least, formula = (near.order if near else 0) + 1, structure.defect_formula
    if near is not None and claimed is not None and claimed <= least:
        reason = prose(read_prose(f"`{formula}` is `O(h^{least})`: "), describe_nearby(near))
        return PrintedJudgement(near.verdict, reason, Leading(least, Decision(None)))
    most = (claimed or max(least, scheme.order + 1) + _MOST_BEYOND) - 1
    power = power_that_remains(scheme, hamiltonian, structure, most)
    if power is None:
        return None
    if power == leading.power:
        return PrintedJudgement(
            Verdict.REFUTED, read_prose(f"`{formula}` begins with `h^{power}`"), leading
        )
    term = read_prose(f"whatever the digits stand for, `{formula}` has a term with `h^{power}`")
    return PrintedJudgement(Verdict.REFUTED, term, Leading(power, Decision(False)))


def prints_decimals(scheme: Scheme, hamiltonian: Hamiltonian) -> bool:
    """Return True if some coefficients are decimals that may stand for other numbers."""
    try:
        return next(_maps_of(scheme, hamiltonian), None) is not None
    except InputError:  # there are some, and the map with variables for them is too long
        return True


@lru_cache(maxsize=16)
def power_that_remains(
    scheme: Scheme, hamiltonian: Hamiltonian, structure: Structure, most: int
) -> int | None:
    """Return the least power of h, at most `most`, that the defect has for all coefficients.

    They are all that the printed ones may stand for; None if there is no such power, or none is
    found.
    """
    search = partial(_search, scheme, hamiltonian, structure, most)
    try:
        return answer_unless_long(search, None, MAX_CALLS)
    except InputError:  # a decimal stands where the map is no series in it
        return None


def _search(
    scheme: Scheme, hamiltonian: Hamiltonian, structure: Structure, most: int
) -> int | None:
    maps = list(_maps_of(scheme, hamiltonian))
    defects = [structure.defect(series_values(step_map, structure, most)) for step_map, _ in maps]

    def remains(n: int) -> bool:
        """Return True if hⁿ remains in every reading: the digits do not say which is meant."""
        for (_, printed), defect in zip(maps, defects, strict=True):
            coefficients = [(x.ring, x.coefficients[n]) for x in defect.values()]
            if not any(_is_nonzero(printed, n, *x) for x in coefficients):
                return False
        return bool(maps)

    return next(filter(remains, range(1, most + 1)), None)


def _is_nonzero(printed: PrintedMap, n: int, ring: Ring, x: Poly) -> bool:
    (numbers,) = printed.readings
    return printed.find_nonzero(n, numbers, lambda _: (ring, [x])) is not None


def _maps_of(scheme: Scheme, hamiltonian: Hamiltonian) -> Iterator[tuple[StepMap, PrintedMap]]:
    """Yield the map with variables for its decimals, by each reading of these."""
    if scheme.formulas:
        yield from named_maps(tuple(scheme.formulas.items()), hamiltonian)
    every_h = scheme.every_h
    if isinstance(every_h, TreeConditions | RungeKutta):
        yield from _maps_of_tableau(conditions_for(every_h), hamiltonian)
    if not isinstance(every_h, Splitting):
        return
    timed = hamiltonian.time_dependent
    parts = every_h.nearby_in_time if timed else every_h.nearby
    for table in parts.tables if isinstance(parts, PrintedParts) else ():
        kinds = (kind for kind, _ in table.parts)
        sized = tuple(zip(kinds, table.sizes, strict=True))
        times = dict(zip(table.judged_parts, table.entries[len(sized) :], strict=True))
        clock = tuple(times.get(k) for k in range(len(sized))) if timed else ()
        named = replace(every_h, raw_parts=sized, times=clock)
        names = tuple(table.printed.units)
        step_map = kind_of(named, scheme.name).build(named, hamiltonian, scheme.name)
        yield step_map, PrintedMap(names, (table.printed,))


def _maps_of_tableau(
    method: Splitting | TreeConditions, hamiltonian: Hamiltonian
) -> Iterator[tuple[StepMap, PrintedMap]]:
    """Yield the map of a tableau, with a variable for each long decimal; its clock is the right
    one."""
    tableau = getattr(method, "tableau", None)
    if tableau is None or len(tableau.parts) > 1:
        return
    entries = [x for row in (*tableau.rows, tableau.weights) for x in row]
    texts = {x: text for x in entries if (text := _decimal_text(x))}
    names = {x: f"coefficient{k}" for k, x in enumerate(texts)}
    printed = PrintedNumbers({names[x]: text for x, text in texts.items()})
    for numbers in printed.of_a_method() if texts else ():
        if not numbers.units:
            continue
        named = [symbol(names[x]) if names.get(x) in numbers.units else x for x in entries]
        field, exact = field_of(hamiltonian, *named)
        count = tableau.stages
        rows = [exact[count * k : count * (k + 1)] for k in range(count)]
        clocks = [sum(row, field.ring.zero) for row in rows]
        step = implicit_step(rows, exact[count * count :], clocks)
        yield StepMap(hamiltonian, field, step), PrintedMap(tuple(numbers.units), (numbers,))


def _decimal_text(x: sympy.Expr) -> str:
    """Return a number that is a finite decimal as one; "" for another."""
    places = range(_MOST_PLACES) if x.is_Rational else ()
    least = next((k for k in places if 10**k % int(x.q) == 0), 0)
    if not least:
        return ""
    digits = str(abs(int(x * 10**least))).rjust(least + 1, "0")
    return f"{'-' * bool(x < 0)}{digits[:-least]}.{digits[-least:]}"
