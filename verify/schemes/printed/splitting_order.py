"""The order of a printed splitting, and a test that its clocks are the right ones.

Where each time is the right one, the sum of the other kind's parts before it, the conditions
without time suffice, except for a quadratic T that depends on time
(`verify.schemes.conditions.splitting_conditions`). Where one is not, those of words with time
decide (`verify.schemes.conditions.words.equations`).
"""

from collections.abc import Sequence
from dataclasses import replace

from verify.arithmetic.number import E
from verify.errors import InputError
from verify.schemes.conditions.splitting_conditions import sums_before
from verify.schemes.conditions.words.equations import equations_of
from verify.schemes.conditions.words.kinetic import Kinetic
from verify.schemes.printed.condition_set import ConditionSet, NamedEquation, prepend_conditions
from verify.schemes.printed.judged import Judged, judge
from verify.schemes.printed.splitting_table import PrintedTable
from verify.verdict import Verdict

_MOST_ORDER = 6  # with clocks that are not right: of higher ones there are too many words


def judge_clocks(table: PrintedTable) -> Judged:
    """Judge whether each time is the right one."""
    return judge(table.printed, _clock_conditions(table), 1)


def judge_order(table: PrintedTable, order: int) -> Judged:
    """Judge whether it can have the order: with times, for the class of T, as they are printed.

    InputError where it cannot be looked at so far.
    """
    if not 1 <= order <= table.most_order:
        problem = f"of a {table.kind} is looked at up to {table.most_order}"
        raise InputError("order", order, problem)
    if not table.judged_parts and table.kinetic is not Kinetic.MASS:
        return judge(table.printed, table.condition_set(order), order)
    right = judge_clocks(table).verdict is not Verdict.REFUTED
    # With right clocks the conditions without time suffice: see `splitting_conditions`.
    if right and table.kinetic is not Kinetic.MASS:
        plain = table.condition_set(order)
        judged = judge(table.printed, prepend_conditions(plain, _clock_conditions(table)), order)
        if judged.verdict is not Verdict.REFUTED:
            return judged
    most = min(order, _MOST_ORDER)
    for n in range(1, most + 1):  # of a wrong clock it is mostly a low order that fails
        judged = judge(table.printed, _word_conditions(table, n), n)
        if judged.verdict is Verdict.REFUTED:
            return judged
    return judged if most == order else replace(judged, verdict=Verdict.UNDECIDED)


def _clock_conditions(table: PrintedTable) -> ConditionSet:
    names = (
        f"time of {table.parts[k][0]} {k + 1} = {_before(table, k)}" for k in table.judged_parts
    )

    def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        count, sign = len(table.parts), 1 if bound else -1
        right, times = _right(table, entries[:count], one), entries[count:]
        return [time + right[k] * sign for k, time in zip(table.judged_parts, times, strict=True)]

    equations = tuple(NamedEquation(name, 1) for name in names)
    return ConditionSet(table.entries, equations, residues, labels=table.labels)


def _before(table: PrintedTable, k: int) -> str:
    other = "drifts" if table.parts[k][0] == "kick" else "kicks"
    return f"sum of the {other} before it"


def _right(table: PrintedTable, sizes: Sequence[E], one: E) -> list[E]:
    kinds = (kind for kind, _ in table.parts)
    return sums_before(list(zip(kinds, sizes, strict=True)), one * 0)


def _word_conditions(table: PrintedTable, order: int) -> ConditionSet:
    equations = tuple(x for n in range(1, order + 1) for x in equations_of(table.kinetic, n))

    def residues(entries: Sequence[E], one: E, bound: bool = False) -> list[E]:
        count = len(table.parts)
        sizes, times_of_parts = (
            entries[:count],
            dict(zip(table.judged_parts, entries[count:], strict=True)),
        )
        times = [times_of_parts.get(k, right) for k, right in enumerate(_right(table, sizes, one))]
        return table.residues(equations, sizes, one, bound, times)

    return ConditionSet(table.entries, equations, residues, labels=table.labels)
