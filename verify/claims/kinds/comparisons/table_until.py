"""A printed row of lg MSE is right for some time T up to that of the grid, whichever that was.

For every N the MSE is at most (max |ΔJ|)², which does not decrease with N: a printed value greater
than that of the longest run is wrong for every shorter run too. This can only refute; otherwise the
claim stays UNDECIDED, since every T would have to be examined.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Literal

from verify.arithmetic.arb import Ball, format_ball, is_representable, lg, rational_ball
from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.kinds.table import PrintedTableClaim
from verify.claims.quantities import QUANTITIES, middle, places, sign, start_of
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


class TableUntilClaim(PrintedTableClaim):
    """A printed row for a run whose length is not stated."""

    obstacle = "a printed table is that of its own runs"
    kind: Literal["table_until"]  # type: ignore[assignment]
    quantity: Literal["lg_mse"] = "lg_mse"
    """The printed quantity."""

    def quantities(self) -> tuple[str, ...]:
        return ("delta_j_max",)

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        printed_rows = self.rows or (self.printed or (),) * len(rows)
        grid = findings.scene(self.scene).grid
        verdicts: list[bool | None] = []
        largest: list[Ball] = []
        details: list[Sequence[str]] = [
            ["initial value", *(f"lg (max ΔJ²), h = {text(h)}" for h in self.step_sizes)]
        ]
        for row, printed in zip(rows, printed_rows, strict=True):
            runs = [self.run_at(row, h) for h in self.step_sizes]
            # lg MSE ≤ 2 lg max |ΔJ|, for a mean of squares is at most the greatest square.
            bounds = [2 * lg(QUANTITIES["delta_j_max"](run)) for run in runs]
            for bound, cell in zip(bounds, printed, strict=True):
                # The least number that rounds to the printed one is compared with the bound.
                half = Fraction(10) ** -places(cell) / 2
                verdicts.append(sign(rational_ball(Fraction(cell) - half) - bound))
            largest += bounds
            details.append([start_of(row[0]), *(format_ball(x, 5) for x in bounds)])
        refuted, total = verdicts.count(True), len(verdicts)
        if not refuted:
            evidence = f"none of {total} printed values is known to be greater than lg (max ΔJ²)"
            return self.result(Verdict.UNDECIDED, evidence, details)
        finite = [x for x in largest if is_representable(x)]
        printed_values = (
            f"all {len(self.step_sizes)} printed values, from each of {len(rows)} initial values,"
            if self.printed and refuted == total
            else f"{refuted} of {total} printed values"
        )
        evidence = prose(
            printed_values, " are greater than lg (max ΔJ²) of the longest run",
            *((", T = ", Number(text(grid.time))) if grid and grid.time else ()),
            ", which the lg MSE of no shorter one exceeds; that is at most ",
            number(format_ball(max(finite, key=middle), 5)),
        )  # fmt: skip
        return self.result(Verdict.REFUTED, evidence, details)


CLAIM = TableUntilClaim
