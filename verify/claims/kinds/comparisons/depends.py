"""The quantities depend on the step size, on the initial values, or on both.

Two runs that differ in nothing else and whose enclosures are disjoint show it.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import format_ball
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, Quantity, all_hold, sign
from verify.claims.run_claims import RunClaim
from verify.prose import Prose, join_prose, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.run import RunResult

_NAMES = {"step_size": "step sizes", "initial_value": "initial values"}
On = Literal["step_size", "initial_value"]


class DependsClaim(RunClaim):
    """The claim that values are not all the same."""

    obstacle = "on what values depend is seen on the grid of its own scene"
    kind: Literal["depends"]
    of: Annotated[tuple[Quantity, ...], Field(min_length=1)]
    """The quantities that vary."""
    on: Annotated[tuple[On, ...], Field(min_length=1)]
    """The data on which they depend."""

    def quantities(self) -> tuple[str, ...]:
        return self.of

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        groups: dict[str, Sequence[Sequence[RunResult]]] = {
            "step_size": rows,
            "initial_value": list(zip(*rows, strict=True)),
        }
        comparisons = [
            (name, on, _find_different(name, groups[on])) for name in self.of for on in self.on
        ]
        verdicts = [verdict for _, _, (verdict, _) in comparisons]
        parts = (
            prose(f"{QUANTITIES[name].label} with two {_NAMES[on]}: ", values)
            for name, on, (_, values) in comparisons
        )
        return self.result(all_hold(verdicts), join_prose("; ", parts))


def _find_different(name: str, groups: Sequence[Sequence[RunResult]]) -> tuple[bool | None, Prose]:
    """Return True if two runs of a group have different values, and both values.

    Returns False if all values are the same, and None if neither is decided.
    """
    quantity, same = QUANTITIES[name], True
    for run, other_run in _pairs(groups):
        value, other_value = quantity(run), quantity(other_run)
        if sign(other_value - value, zero=None) is not None:
            values = (number(format_ball(value, 3)), " and ", number(format_ball(other_value, 3)))
            return True, prose(*values)
        # Exact values with equal decimals are the same; enclosures that overlap decide nothing.
        same = same and _equal(run, other_run, quantity.needs)
    return (False, prose("all the same")) if same else (None, prose("not told apart"))


def _equal(run: RunResult, other_run: RunResult, names: Sequence[str]) -> bool:
    """Return True if the values are exact, and their decimals equal."""
    pairs = [(run.values[name], other_run.values[name]) for name in names]
    are_exact = all(Fraction(value.bound) == 0 for pair in pairs for value in pair)
    return are_exact and all(Fraction(a.value) == Fraction(b.value) for a, b in pairs)


def _pairs(groups: Sequence[Sequence[RunResult]]) -> Iterator[tuple[RunResult, RunResult]]:
    for group in groups:
        yield from combinations(group, 2)


CLAIM = DependsClaim
