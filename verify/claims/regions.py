"""Claims about regions that maps carry: that their area is kept, and that flows coincide."""

from collections.abc import Iterator
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.arithmetic.exact import text
from verify.claims.findings import Checks, Findings, result
from verify.claims.kinds import FlowAreaClaim, FlowClaim, FlowDistanceClaim
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.regions import EXACT_FLOW, FlowImage
from verify.scenes.scene import Scene
from verify.studies.regions.plan import flow_tasks
from verify.studies.regions.task import FlowTask
from verify.verdict import Verdict

_HEAD = ("h", "N", "t")


def flow_tasks_of(claim: FlowClaim, scene: Scene) -> Iterator[FlowTask]:
    """Those of the scene's tasks that the claim speaks of."""
    for section in scene.flow:
        if section.source in claim.flows:
            yield from (t for t in flow_tasks(scene, section) if t.map == claim.scheme)


def check_flow_area(claim: FlowAreaClaim, findings: Findings) -> ClaimResult:
    """Exactly by proof; or within so much, by what was measured."""
    scene = findings.scene(claim.scene)
    images = _images(claim, scene, findings)
    details = [
        [*_HEAD, "change of area", "its error", "mean of Λ"],
        *(
            [*at, image.area_change or "unknown", image.probe_error or "unknown", _mean(image)]
            for at, image in images
        ),
    ]
    known = [(at, image) for at, image in images if image.area_change is not None]
    doubtful = [image for _, image in images if image.problem or image.agree is False]
    if claim.scheme == EXACT_FLOW and conserves_area(scene.exact_hamiltonian()):
        said = f"∂(−H_q)/∂p + ∂H_p/∂q = 0 identically, so that det ≡ 1; {_largest(known)}"
        return result(claim, Verdict.PROVED, said, details)
    if images and all(image.area_preserving for _, image in images):
        return result(claim, Verdict.PROVED, f"det J ≡ 1; {_largest(known)}", details)
    certain = [each for each in known if each[1] not in doubtful]
    ends = [_ends(image) for _, image in certain]
    refuted = any(low > (claim.within or 0) for low, _ in ends)  # one image is enough
    if not refuted and (doubtful or not known):
        reason = next((i.problem for i in doubtful if i.problem), "the two measures disagree")
        return result(claim, Verdict.UNDECIDED, reason, details)
    if claim.within is None:
        verdict = Verdict.REFUTED if refuted else Verdict.UNDECIDED
        return result(claim, verdict, _largest(certain), details)
    return result(claim, _within(ends, claim.within), _against(certain, claim.within), details)


def check_flow_distance(claim: FlowDistanceClaim, findings: Findings) -> ClaimResult:
    """Whether every image lies so close to that by the exact flow."""
    images = _images(claim, findings.scene(claim.scene), findings)
    details = [
        [*_HEAD, "distance from the exact flow", "its error"],
        *(
            [*at, image.distance or "unknown", image.distance_error or "unknown"]
            for at, image in images
        ),
    ]
    known = [(at, image) for at, image in images if image.distance is not None]
    ends = [_around(image.distance, image.distance_error) for _, image in known]
    verdict = _within(ends, claim.within)
    if not known or (len(known) < len(images) and verdict is not Verdict.REFUTED):
        reason = next((i.problem for _, i in images if i.problem), "a distance is not known")
        return result(claim, Verdict.UNDECIDED, reason, details)
    at, worst = max(known, key=lambda each: Fraction(each[1].distance or 0))
    evidence = (
        f"the largest of {len(known)} Hausdorff distances from the exact flow’s outlines is "
        f"{worst.distance} ± {worst.distance_error} ({_step_and_count(at)}; allowed here: "
        f"{text(claim.within)})"
    )
    return result(claim, verdict, evidence, details)


def conserves_area(hamiltonian: Hamiltonian) -> bool:
    """Liouville's theorem, checked for this H: its vector field has no divergence."""
    h, p, q = hamiltonian.expression, symbol("p"), symbol("q")
    divergence = sympy.diff(-sympy.diff(h, q), p) + sympy.diff(sympy.diff(h, p), q)
    return bool(sympy.expand(divergence) == 0)


# -- numbers --------------------------------------------------------------------------------------

_At = tuple[str, str, str]  # h, N, t


def _images(claim: FlowClaim, scene: Scene, findings: Findings) -> list[tuple[_At, FlowImage]]:
    found = []
    for task in flow_tasks_of(claim, scene):
        image = findings.results.get(task.key)
        if isinstance(image, FlowImage):
            found.append(((text(task.step_size), str(image.steps), image.time), image))
    return found


def _ends(image: FlowImage) -> tuple[Fraction, Fraction]:
    """The least and the greatest that |change| may be; 0 where its sign is not known."""
    return _around(image.area_change, image.probe_error)


def _around(value: str | None, error: str | None) -> tuple[Fraction, Fraction]:
    size, apart = abs(Fraction(value or 0)), Fraction(error or 0)
    return max(size - apart, Fraction(0)), size + apart


def _within(ends: list[tuple[Fraction, Fraction]], allowed: Fraction) -> Verdict:
    if any(low > allowed for low, _ in ends):
        return Verdict.REFUTED
    return Verdict.MEASURED if all(high <= allowed for _, high in ends) else Verdict.UNDECIDED


def _largest(known: list[tuple[_At, FlowImage]]) -> str:
    if not known:
        return "nothing was measured"
    at, image = max(known, key=lambda each: _ends(each[1])[1])
    measured = f"{image.area_change} ± {image.probe_error}"
    return f"the area of the region changes by {measured} of it ({_step_and_count(at)})"


def _against(known: list[tuple[_At, FlowImage]], allowed: Fraction) -> str:
    return f"{_largest(known)}, the largest of {len(known)} changes; allowed here: {text(allowed)}"


def _step_and_count(at: _At) -> str:
    return f"h = {at[0]}, N = {at[1]}"


def _mean(image: FlowImage) -> str:
    if image.mean_lambda is None:
        return "0, by proof" if image.area_preserving else "not computed"
    return f"{image.mean_lambda} ± {image.mean_lambda_error}"


CHECKS: Checks = {FlowAreaClaim: check_flow_area, FlowDistanceClaim: check_flow_distance}
