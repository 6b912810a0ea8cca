"""The quantity rises or falls with the step size in the same way from every initial value."""

from itertools import pairwise
from typing import Literal

from verify.claims.base_claim import Findings
from verify.claims.quantities import QUANTITIES, all_hold, sign, table_of
from verify.claims.run_claims import QuantityClaim
from verify.prose import Number, Prose, join_prose, prose
from verify.scenes.results.claim import ClaimResult

_DIRECTIONS = {True: "rises", False: "falls"}


class AlikeClaim(QuantityClaim):
    """One pattern over the step sizes, whatever the initial value."""

    obstacle = "a pattern is over the initial values of its own scene"
    kind: Literal["alike"]

    def compare(self, findings: Findings) -> ClaimResult:
        rows, quantity = self.run_rows(findings), QUANTITIES[self.quantity]
        verdicts: list[bool | None] = []
        parts: list[Prose] = []
        patterns: list[str] = []
        for column in zip(*(list(pairwise(row)) for row in rows), strict=True):
            directions = [sign(quantity(coarser) - quantity(finer)) for finer, coarser in column]
            # If one of the changes is undecided, so is the pattern between these step sizes.
            same = None if None in directions else len(set(directions)) == 1
            verdicts.append(same)
            finer, coarser = column[0]
            pattern = "is not told apart" if same is None else _describe(directions)
            patterns.append(pattern)
            parts.append(prose(
                "from h = ", Number(finer.step_size), " to ", Number(coarser.step_size),
                f" it {pattern}",
            ))  # fmt: skip
        if len(set(patterns)) == 1:
            pairs = f"between all {len(patterns)} neighbouring step sizes"
            evidence = prose(f"{quantity.label} {patterns[0]} {pairs}")
        else:
            some = [part for part, same in zip(parts, verdicts, strict=True) if same is not True]
            kept = [part for part, same in zip(parts, verdicts, strict=True) if same is True]
            evidence = prose(f"{quantity.label}: ", join_prose(", ", some or kept))
            if some and kept:
                evidence = prose(
                    evidence, "; between the other step sizes it goes one way from all"
                )
        return self.result(all_hold(verdicts), evidence, table_of(rows, self.quantity))


def _describe(directions: list[bool | None]) -> str:
    if len(set(directions)) == 1:
        return f"{_DIRECTIONS[bool(directions[0])]} from all {len(directions)} initial values"
    return f"rises from {directions.count(True)} and falls from {directions.count(False)}"


CLAIM = AlikeClaim
