"""Each quantity is about 10^exponent at `step_size`: its lg differs from the exponent by at most ½.

This holds for some initial value of the grid, or for every one.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.arb import format_ball, lg, rational_ball
from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, Quantity, all_hold, sign, some_hold, start_of
from verify.claims.run_claims import RunClaim
from verify.errors import InputError
from verify.prose import Formula, Prose, join_prose, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.scenes.values import StepSize


class MagnitudeClaim(RunClaim):
    """The order of magnitude of quantities at one step size."""

    kind: Literal["magnitude"]
    step_size: StepSize
    """The step size that is spoken of."""
    exponents: Annotated[dict[Quantity, int], Field(min_length=1)]
    """The power of ten of each quantity."""
    quantifier: Literal["some", "every"]
    """The number of initial values for which it holds: some, or every one."""

    def quantities(self) -> tuple[str, ...]:
        return tuple(self.exponents)

    def check_scene(self, scene: Scene) -> None:
        if scene.grid is not None and self.step_size not in scene.grid.step_sizes:
            raise InputError("step_size", text(self.step_size), "is not in the scene's grid")

    def compare(self, findings: Findings) -> ClaimResult:
        names = tuple(self.exponents)
        rows = self.run_rows(findings)
        heads = [
            prose(QUANTITIES[n].label, " (about ", Formula(f"10^{self.exponents[n]}"), "?)")
            for n in names
        ]
        details: list[list[str]] = [["initial value", *heads]]
        holds: list[bool | None] = []
        failing: list[Prose] = []
        for row in rows:
            run = self.run_at(row, self.step_size)
            values = {name: QUANTITIES[name](run) for name in names}
            distances = [abs(lg(values[n]) - self.exponents[n]) for n in names]
            # "About 10^e" is read as: nearer to 10^e than to any other power of ten.
            are_near = [sign(rational_ball(Fraction(1, 2)) - x) for x in distances]
            holds.append(_every(are_near))
            wrong = [n for n, answer in zip(names, are_near, strict=True) if answer is False]
            parts = [
                prose(f"{QUANTITIES[n].label} = ", number(format_ball(values[n], 2))) for n in wrong
            ]
            failing.append(prose(start_of(row[0]), ": ", join_prose(", ", parts)))
            details.append([start_of(row[0]), *(format_ball(values[n], 4) for n in names)])
        holding = [
            start_of(row[0]) for row, answer in zip(rows, holds, strict=True) if answer is True
        ]
        not_holding = [
            description
            for description, answer in zip(failing, holds, strict=True)
            if answer is False
        ]
        if holding:
            evidence = prose("it holds for ", _list(holding))
            if not_holding:
                evidence = prose(evidence, "; it does not hold for ", _list(not_holding))
        elif not_holding:
            evidence = prose(
                "it holds for none of the initial values: ", join_prose("; ", not_holding)
            )
        else:
            evidence = prose("it is decided for none of the initial values")
        decide = some_hold if self.quantifier == "some" else all_hold
        return self.result(decide(holds), evidence, details)


def _every(answers: Sequence[bool | None]) -> bool | None:
    return False if False in answers else None if None in answers else True


def _list(names: Sequence[Prose]) -> Prose:
    text = join_prose("; ", (prose("(", name, ")") for name in names))
    return text or prose("none of the initial values")


CLAIM = MagnitudeClaim
