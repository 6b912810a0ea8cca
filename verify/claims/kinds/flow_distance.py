"""The images' outlines lie so close to those by the exact flow (Hausdorff distance), or one does
not."""

from fractions import Fraction
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import text
from verify.claims.findings import Findings
from verify.claims.regions import HEAD, FlowClaim, Image, around, within
from verify.errors import NOT_GIVEN, InputError
from verify.prose import Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import Number as ExactNumber
from verify.verdict import Verdict


class FlowDistanceClaim(FlowClaim):
    """Whether every image lies so close to that by the exact flow, or one farther from it."""

    kind: Literal["flow_distance"]
    within: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The largest distance of the outlines; or `beyond`."""
    beyond: Annotated[ExactNumber, Field(gt=0)] | None = None
    """What the largest distance of the outlines exceeds; or `within`."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.within is None) == (self.beyond is None):
            raise InputError("within, beyond", NOT_GIVEN, "give one of the two")
        return self

    def judge(self, findings: Findings) -> ClaimResult:
        images = self.images(findings)
        details = [[*HEAD, "distance from the exact flow", "its error"], *map(_row, images)]
        known = [image for image in images if image.found.distance is not None]
        ends = [around(image.found.distance, image.found.distance_error) for image in known]
        limit = self.within or self.beyond or Fraction(0)
        verdict = within(ends, limit)
        certain = verdict is Verdict.REFUTED  # one image is enough
        if self.beyond is not None and verdict is not Verdict.UNDECIDED:
            verdict = Verdict.MEASURED if certain else Verdict.REFUTED
        if not known or (len(known) < len(images) and not certain):
            reasons = (image.found.problem for image in images if image.found.problem)
            reason = next(reasons, "a distance is not known")
            return self.result(Verdict.UNDECIDED, reason, details)
        worst = max(known, key=lambda each: Fraction(each.found.distance or 0))
        evidence = prose(
            f"the largest of {len(known)} Hausdorff distances from the exact flow’s outlines is ",
            Number(worst.found.distance or ""), " ± ", Number(worst.found.distance_error or ""),
            " (", worst.place, "; allowed here: " if self.within else "; to be exceeded: ",
            Number(text(limit)), ")",
        )  # fmt: skip
        return self.result(verdict, evidence, details)


def _row(image: Image) -> list[str]:
    found = image.found
    return [*image.cells, found.distance or "unknown", found.distance_error or "unknown"]


CLAIM = FlowDistanceClaim
