"""A printed row of lg MSE is right for some time T up to that of the grid, whichever that was.

For every N an MSE is at most (max |ΔJ|)², which does not decrease with N: where what is printed is
greater than that of the longest run, it is wrong for every shorter one too. This can refute; what
it does not refute stays UNDECIDED, for then each T had to be looked at.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Literal

from verify.arithmetic.arb import Ball, in_reach, lg, rational_ball, shown
from verify.arithmetic.exact import text
from verify.claims.findings import Findings
from verify.claims.kinds.table import TableClaim
from verify.claims.printed import places
from verify.claims.runs import QUANTITIES, middle, sign, start_of
from verify.prose import Number, number, prose
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict


class TableUntilClaim(TableClaim):
    """A printed row, of a time that is not told."""

    only_here = "a printed table is that of its own runs"
    kind: Literal["table_until"]  # type: ignore[assignment]
    quantity: Literal["lg_mse"] = "lg_mse"
    """What the row prints."""

    def quantities(self) -> tuple[str, ...]:
        return ("delta_j_max",)

    def compare(self, findings: Findings) -> ClaimResult:
        rows = self.run_rows(findings)
        printed_rows = self.rows or (self.printed or (),) * len(rows)
        grid = findings.scene(self.scene).grid
        beyond: list[bool | None] = []
        largest: list[Ball] = []
        details: list[Sequence[str]] = [
            ["initial value", *(f"lg (max ΔJ²), h = {text(h)}" for h in self.step_sizes)]
        ]
        for row, printed in zip(rows, printed_rows, strict=True):
            runs = [self.run_at(row, h) for h in self.step_sizes]
            most = [2 * lg(QUANTITIES["delta_j_max"](run)) for run in runs]
            for bound, cell in zip(most, printed, strict=True):
                half = Fraction(10) ** -places(cell) / 2
                beyond.append(sign(rational_ball(Fraction(cell) - half) - bound))
            largest += most
            details.append([start_of(row[0]), *(shown(x, 5) for x in most)])
        refuted, total = beyond.count(True), len(beyond)
        if not refuted:
            evidence = f"none of {total} printed values is known to be greater than lg (max ΔJ²)"
            return self.result(Verdict.UNDECIDED, evidence, details)
        known = [x for x in largest if in_reach(x)]
        evidence = prose(
            f"{refuted} of {total} printed values are greater than lg (max ΔJ²) of the longest "
            "run", *((", T = ", Number(text(grid.time))) if grid and grid.time else ()),
            ", so for every shorter one too; that is at most ",
            number(shown(max(known, key=middle), 5)),
        )  # fmt: skip
        return self.result(Verdict.REFUTED, evidence, details)


CLAIM = TableUntilClaim
