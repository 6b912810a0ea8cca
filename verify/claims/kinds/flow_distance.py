"""The images' outlines lie so close to those by the exact flow (Hausdorff distance)."""

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from verify.arithmetic.exact import text
from verify.claims.findings import Findings
from verify.claims.regions import HEAD, FlowClaim, Image, around, within
from verify.prose import Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import Number as ExactNumber
from verify.verdict import Verdict


class FlowDistanceClaim(FlowClaim):
    """Whether every image lies so close to that by the exact flow."""

    kind: Literal["flow_distance"]
    within: Annotated[ExactNumber, Field(gt=0)]
    """The largest distance of the outlines."""

    def judge(self, findings: Findings) -> ClaimResult:
        images = self.images(findings)
        details = [[*HEAD, "distance from the exact flow", "its error"], *map(_row, images)]
        known = [image for image in images if image.found.distance is not None]
        ends = [around(image.found.distance, image.found.distance_error) for image in known]
        verdict = within(ends, self.within)
        if not known or (len(known) < len(images) and verdict is not Verdict.REFUTED):
            reasons = (image.found.problem for image in images if image.found.problem)
            reason = next(reasons, "a distance is not known")
            return self.result(Verdict.UNDECIDED, reason, details)
        worst = max(known, key=lambda each: Fraction(each.found.distance or 0))
        evidence = prose(
            f"the largest of {len(known)} Hausdorff distances from the exact flow’s outlines is ",
            Number(worst.found.distance or ""), " ± ", Number(worst.found.distance_error or ""),
            " (", worst.place, "; allowed here: ", Number(text(self.within)), ")",
        )  # fmt: skip
        return self.result(verdict, evidence, details)


def _row(image: Image) -> list[str]:
    found = image.found
    return [*image.cells, found.distance or "unknown", found.distance_error or "unknown"]


CLAIM = FlowDistanceClaim
