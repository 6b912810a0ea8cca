"""A claim that cannot be read: too large, or in functions that are not known; so it is undecided.

The others of its file are none the worse for it.
"""

from typing import Any

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.prose import prose
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

_OF_READINGS = ("reading_of", "reading", "standing")
_KEPT = ("id", "kind", "source", "section", "statement", "scheme", *_OF_READINGS)


class OutsideClaim(Claim):
    """`problem`: what is beyond the limits, in one line."""

    on_scene = False
    only_here = "it could not be read"
    problem: str

    def judge(self, findings: Findings) -> ClaimResult:
        return self.result(Verdict.UNDECIDED, prose(self.problem))


def outside(table: dict[str, Any], problem: str) -> OutsideClaim:
    """The claim of that table. Raises pydantic's ValidationError where its texts are none."""
    known = {key: table[key] for key in _KEPT if key in table}
    return OutsideClaim.model_validate({"scheme": "", **known, "problem": problem})
