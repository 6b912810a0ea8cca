"""The map preserves the region's area exactly, or changes it by at most this part of it."""

from collections.abc import Sequence
from typing import Annotated, Literal

import sympy
from pydantic import Field

from verify.algebra.formula import symbol
from verify.arithmetic.exact import text
from verify.claims.base_claim import Findings
from verify.claims.region_claims import HEAD, FlowClaim, Image, judge_sizes
from verify.effort import answer_unless_long
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Formula, Number, Prose, prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.regions import EXACT_FLOW, FlowImage
from verify.scenes.values import ExactNumber
from verify.verdict import Verdict

_LIOUVILLE = Formula("∂(−H_q)/∂p + ∂H_p/∂q = 0")


class FlowAreaClaim(FlowClaim):
    """The area is preserved exactly, by proof, or within a bound, by measurement."""

    kind: Literal["flow_area"]
    within: Annotated[ExactNumber, Field(gt=0)] | None = None
    """The largest part of the area that the change may be; exactly 0, if it is left out."""

    def judge(self, findings: Findings) -> ClaimResult:
        images = self.images(findings)
        details = [[*HEAD, "change of area", "its error", "mean of Λ"], *map(_row, images)]
        measured_images = [image for image in images if image.result.area_change is not None]
        scene = findings.scene(self.scene)
        if self.scheme == EXACT_FLOW and conserves_area(scene.exact_hamiltonian()):
            evidence = prose(
                _LIOUVILLE, " identically, so that det ≡ 1; ", _largest(measured_images)
            )
            return self.result(Verdict.PROVED, evidence, details)
        if images and all(image.result.area_preserving for image in images):
            return self.result(Verdict.PROVED, "det J ≡ 1; " + _largest(measured_images), details)
        # The two measures of area are independent; if they disagree, neither is trusted.
        doubtful = [i for i in images if i.result.problem or i.result.agree is False]
        certain = [image for image in measured_images if image not in doubtful]
        ends = [image.change for image in certain]
        refuted = any(low > (self.within or 0) for low, _ in ends)  # one image is enough
        if not refuted and (doubtful or not measured_images):
            reasons = (image.result.problem for image in doubtful if image.result.problem)
            reason = next(reasons, "the two measures disagree")
            return self.result(Verdict.UNDECIDED, reason, details)
        if self.within is None:
            verdict = Verdict.REFUTED if refuted else Verdict.UNDECIDED
            return self.result(verdict, _largest(certain), details)
        against = prose(
            _largest(certain), f", the largest of {len(certain)} changes; the claim: at most ",
            Number(text(self.within)),
        )  # fmt: skip
        return self.result(judge_sizes(ends, self.within), against, details)


def conserves_area(hamiltonian: Hamiltonian) -> bool:
    """Return True if the vector field of H has no divergence (Liouville's theorem)."""
    h, p, q = hamiltonian.expression, symbol("p"), symbol("q")
    divergence = sympy.diff(-sympy.diff(h, q), p) + sympy.diff(sympy.diff(h, p), q)
    return answer_unless_long(lambda: bool(sympy.expand(divergence) == 0), otherwise=False)


def _row(image: Image) -> list[str]:
    result = image.result
    change = result.area_change or "unknown"
    return [*image.cells, change, result.probe_error or "unknown", _mean(result)]


def _mean(image: FlowImage) -> str:
    if image.mean_lambda is None:
        return "0, by proof" if image.area_preserving else "not computed"
    return prose(Number(image.mean_lambda), " ± ", Number(image.mean_lambda_error or ""))


def _largest(images: Sequence[Image]) -> Prose:
    if not images:
        return prose("nothing was measured")
    image = max(images, key=lambda x: x.change.high)
    return prose(
        "the area of the region changes by ", Number(image.result.area_change or ""), " ± ",
        Number(image.result.probe_error or ""), " of it (", image.place, ")",
    )  # fmt: skip


CLAIM = FlowAreaClaim
