"""The quantities depend on the step size, on the initial values, or on both.

Shown by two runs that differ in nothing else and whose values are apart by more than their bounds.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import shown
from verify.claims.findings import Findings
from verify.claims.on_runs import RunClaim
from verify.claims.runs import QUANTITIES, Quantity, all_hold, sign
from verify.prose import Prose, joined, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult

_NAMES = {"step_size": "step sizes", "initial_value": "initial values"}
On = Literal["step_size", "initial_value"]


class DependsClaim(RunClaim):
    """That values are not all the same."""

    only_here = "on what values depend is seen on the grid of its own scene"
    kind: Literal["depends"]
    of: Annotated[tuple[Quantity, ...], Field(min_length=1)]
    """What is said to vary."""
    on: Annotated[tuple[On, ...], Field(min_length=1)]
    """With what it varies."""

    def quantities(self) -> tuple[str, ...]:
        return self.of

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        groups: dict[str, Sequence[Sequence[RunResult]]] = {
            "step_size": rows,
            "initial_value": list(zip(*rows, strict=True)),
        }
        found = [(name, on, _apart(name, groups[on])) for name in self.of for on in self.on]
        verdicts = [told for _, _, (told, _) in found]
        said = (
            prose(f"{QUANTITIES[name].label} over the {_NAMES[on]}: ", values)
            for name, on, (_, values) in found
        )
        return self.result(all_hold(verdicts), joined("; ", said))


def _apart(name: str, groups: Sequence[Sequence[RunResult]]) -> tuple[bool | None, Prose]:
    """Whether two runs of a group have different values, and the two that show it."""
    quantity, same = QUANTITIES[name], True
    for one, two in _pairs(groups):
        first, second = quantity(one), quantity(two)
        if sign(second - first, zero=None) is not None:
            values = (number(shown(first, 3)), " and ", number(shown(second, 3)))
            return True, prose(*values)
        same = same and _equal(one, two, quantity.needs)
    return (False, prose("all the same")) if same else (None, prose("not told apart"))


def _equal(one: RunResult, two: RunResult, names: Sequence[str]) -> bool:
    """Whether the values are known to be the same: exact ones, by equal decimals."""
    both = [(one.values[name], two.values[name]) for name in names]
    exact = all(Fraction(each.bound) == 0 for pair in both for each in pair)
    return exact and all(Fraction(a.value) == Fraction(b.value) for a, b in both)


def _pairs(groups: Sequence[Sequence[RunResult]]) -> Iterator[tuple[RunResult, RunResult]]:
    for group in groups:
        yield from combinations(group, 2)


CLAIM = DependsClaim
