"""The Hausdorff distance of all images' outlines from those by the exact flow is within a bound,
or one exceeds it."""

from fractions import Fraction
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.region_claims import HEAD, FlowClaim, Image, judge_sizes, size_bounds
from verify.errors import NOT_GIVEN, InputError
from verify.prose import Number, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.values import ExactNumber
from verify.verdict import Verdict


class FlowDistanceClaim(FlowClaim):
    """Every image is close to the one by the exact flow, or one of them is far from it."""

    kind: Literal["flow_distance"]
    within: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The largest distance of the outlines; or `beyond`."""
    beyond: Annotated[ExactNumber, Field(gt=0)] | None = None
    """A bound that the largest distance of the outlines exceeds; or `within`."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.within is None) == (self.beyond is None):
            raise InputError("within, beyond", NOT_GIVEN, "give one of the two")
        return self

    def judge(self, findings: Findings) -> ClaimResult:
        images = self.images(findings)
        details = [[*HEAD, "distance from the exact flow", "its error"], *map(_row, images)]
        measured_images = [image for image in images if image.result.distance is not None]
        ends = [
            size_bounds(image.result.distance, image.result.distance_error)
            for image in measured_images
        ]
        limit = self.within or self.beyond or Fraction(0)
        verdict = judge_sizes(ends, limit)
        certain = verdict is Verdict.REFUTED  # one image is enough
        if self.beyond is not None and verdict is not Verdict.UNDECIDED:
            verdict = Verdict.MEASURED if certain else Verdict.REFUTED
        if not measured_images or (len(measured_images) < len(images) and not certain):
            reasons = (image.result.problem for image in images if image.result.problem)
            reason = next(reasons, "a distance is not known")
            return self.result(Verdict.UNDECIDED, reason, details)
        worst = max(measured_images, key=lambda image: Fraction(image.result.distance or 0))
        evidence = prose(
            f"the largest of {len(measured_images)} Hausdorff distances from the exact flow’s ",
            "outlines is ",
            Number(worst.result.distance or ""), " ± ", Number(worst.result.distance_error or ""),
            " (", worst.place, "; the claim: ", "at most " if self.within else "more than ",
            Number(text(limit)), ")",
        )  # fmt: skip
        return self.result(verdict, evidence, details)


def _row(image: Image) -> list[str]:
    result = image.result
    return [*image.cells, result.distance or "unknown", result.distance_error or "unknown"]


CLAIM = FlowDistanceClaim
