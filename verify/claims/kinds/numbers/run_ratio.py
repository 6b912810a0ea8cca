"""The ratio of a number of two runs that differ in the step size, or the order that it measures.

`step_sizes` has two of them; the ratio is that of the run with the larger step to the other one, so
that 4 is what a method of order 2 tends to where the step is halved. With `order = true` it is the
logarithm of the ratio to the base of that of the step sizes. The number is `of` the same names as
that of `run_value`, and its sign does not count.
"""

from fractions import Fraction
from typing import Literal

from verify.arithmetic.arb import Ball, lg, rational_ball
from verify.claims.base_claim import Findings
from verify.claims.kinds.numbers.run_value import RunValueClaim
from verify.errors import NOT_GIVEN, InputError
from verify.scenes.scene import Scene


class RunRatioClaim(RunValueClaim):
    """The ratio of a number of two runs, or the order that it measures."""

    one_run = False
    kind: Literal["run_ratio"]  # type: ignore[assignment]
    order: bool = False
    """The printed number is the order, log of the ratio over log of the ratio of step sizes."""

    def check_scene(self, scene: Scene) -> None:
        super().check_scene(scene)
        grid = scene.grid
        if grid and (len(grid.step_sizes), len(grid.initial_values)) != (2, 1):
            raise InputError("", NOT_GIVEN, "speaks of two runs; give two step_sizes, q and p")

    def compute(self, findings: Findings) -> tuple[Ball, str]:
        (row,) = self.run_rows(findings)
        small, large = (abs(self.value_of_run(findings, run)) for run in row)
        ratio = large / small
        sizes = rational_ball(Fraction(row[1].step_size) / Fraction(row[0].step_size))
        value = lg(ratio) / lg(sizes) if self.order else ratio
        value = lg(value) if self.lg_printed is not None else value
        return value, f", with h = {row[1].step_size} and {row[0].step_size}"

    @property
    def label(self) -> str:
        what = "the order by" if self.order else "the ratio of"
        return f"{what} {super().label}"


CLAIM = RunRatioClaim
