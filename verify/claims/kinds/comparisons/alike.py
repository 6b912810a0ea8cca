"""The quantity rises or falls with the step size in the same way from every initial value."""

from itertools import pairwise
from typing import Literal

from verify.claims.findings import Findings
from verify.claims.on_runs import QuantityClaim
from verify.claims.runs import QUANTITIES, all_hold, sign, table_of
from verify.prose import Number, join_prose, prose
from verify.scenes.results.claim import ClaimResult

_WAYS = {True: "rises", False: "falls"}


class AlikeClaim(QuantityClaim):
    """One pattern over the step sizes, whatever the initial value."""

    only_here = "a pattern is over the initial values of its own scene"
    kind: Literal["alike"]

    def compare(self, findings: Findings) -> ClaimResult:
        rows, quantity = self.run_rows(findings), QUANTITIES[self.quantity]
        verdicts: list[bool | None] = []
        parts = []
        for column in zip(*(list(pairwise(row)) for row in rows), strict=True):
            ways = [sign(quantity(two) - quantity(one)) for one, two in column]
            # If one of the changes is undecided, so is the pattern between these step sizes.
            same = None if None in ways else len(set(ways)) == 1
            verdicts.append(same)
            one, two = column[0]
            way = "is not told apart" if same is None else _way(ways)
            parts.append(prose("from h = ", Number(one.step_size), " to ", Number(two.step_size),
                              f" it {way}"))  # fmt: skip
        evidence = prose(
            f"{quantity.label} from {len(rows)} initial values: ", join_prose(", ", parts)
        )
        return self.result(all_hold(verdicts), evidence, table_of(rows, self.quantity))


def _way(ways: list[bool | None]) -> str:
    if len(set(ways)) == 1:
        return f"{_WAYS[bool(ways[0])]} from all"
    return f"rises from {ways.count(True)} and falls from {ways.count(False)}"


CLAIM = AlikeClaim
