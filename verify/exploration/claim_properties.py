"""Claims as properties: what a claim states about its own scene is tested on drawn scenes.

That makes sense for statements that may hold for many H, such as an order, or a bound of |Λ|.
A formula in p and q, printed numbers, and the image of a region belong to one scene: such claims
are left out, each with the reason.
"""

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

from verify.claims.base_claim import Claim, Findings
from verify.claims.claim_scenes import scene_for
from verify.claims.kinds import models
from verify.claims.quantified_claims import QuantifiedClaim
from verify.claims.verdicts import results_for
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.exploration.property import Property, Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.hamiltonians.canonical_field import canonical_field
from verify.prose import read_prose
from verify.scenes.results.claim import ClaimResult
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.verdict import Verdict

# The name of the scene in the findings: a drawn scene has none.
_NAME = "drawn"


def claims_left_out(claims: Sequence[Claim]) -> dict[str, list[str]]:
    """Return the ids of the claims that cannot be tested on other scenes, by the reason."""
    reasons: dict[str, list[str]] = {}
    for claim in claims:
        if reason := claim.why_not_transferable():
            reasons.setdefault(reason, []).append(claim.id)
    return reasons


def claim_texts(claims: Sequence[Claim]) -> tuple[str, ...]:
    """Return the claims that can be tested on other scenes, as JSON. InputError if none can."""
    transferable = [claim for claim in claims if not claim.why_not_transferable()]
    if not transferable:
        raise InputError(
            "claim", claims[0].id, f"{claims[0].why_not_transferable()}, and no other claim is left"
        )
    return tuple(
        json.dumps(claim.model_dump(mode="json"), sort_keys=True) for claim in transferable
    )


def scheme_of(text: str) -> str:
    """Return the name of the claim's scheme.

    >>> scheme_of('{"kind": "order", "scheme": "lie2"}')
    'lie2'
    """
    scheme: str = json.loads(text)["scheme"]
    return scheme


@lru_cache(maxsize=256)
def claim_property(text: str) -> Property:
    """Build the property of the claim, which tests the claim's own scheme, whatever was drawn."""
    data: dict[str, Any] = json.loads(text)
    claim = models()[data["kind"]].model_validate(data)
    sentence = (
        str(read_prose(claim.statement)) or f"{claim.kind} of {claim.scheme}, as {claim.id} says"
    )
    return Property(claim.id, sentence, partial(_check, claim), claim.scheme)


def _check(claim: Claim, sample: Sample) -> None:
    """Raise Violation if the claim is refuted for the sample's H and run.

    In n degrees of freedom only claims that algebra decides are tested: those on runs belong to the
    plane.
    """
    only_if(sample.light and (sample.limits.runs or not claim.run_keys))
    # Claims on runs are tested where kernels are cheap, and one on a separable H only on such an H.
    separable = isinstance(claim, QuantifiedClaim) and claim.of_separable
    only_if(not separable or canonical_field(sample.hamiltonian)[0].separable)
    claim_sample = _with_scheme(sample, claim.scheme)
    only_if(claim_sample.ordinary)
    with silent_at(InputError):  # too long a formula, or an end of the run that cannot be had
        result = _verdict_on(claim, claim_sample)
    if result.verdict is Verdict.REFUTED:
        raise Violation(result.evidence)
    only_if(result.verdict is not Verdict.UNDECIDED)


def _with_scheme(sample: Sample, name: str) -> Sample:
    """Return the sample with that scheme; Silent if the scheme does not admit its H."""
    scene = sample.scene.model_copy(update={"schemes": (name,), "name": _NAME})
    claim_sample = replace(sample, scheme=get(name), scene=scene)
    with silent_at(InputError):
        _ = claim_sample.step_map
    return claim_sample


def _verdict_on(claim: Claim, sample: Sample) -> ClaimResult:
    """Judge the claim on the sample."""
    # A claim for every H becomes one for this H, which a drawn scene can refute.
    claim = claim.for_hamiltonian(sample.hamiltonian).model_copy(update={"scene": _NAME})
    scenes = {_NAME: _scene(claim, sample)}
    results = results_for(claim, scenes, Store(None), THIS_PROCESS)
    return claim.judge(Findings(scenes, results))


def _scene(claim: Claim, sample: Sample) -> Scene:
    """Return the sample's scene, with the runs that the claim needs."""
    scene = sample.scene
    if not claim.run_keys:
        return scene
    start = {name: sample.run_arguments[name] for name in ("q", "p")}
    runs = {**start, **claim.drawn_runs(sample.step_size, sample.steps)}
    return scene_for(claim, {"scene": _NAME}, runs, lambda _: scene)[1]
