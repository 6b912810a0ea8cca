"""A claim as a property: what it says of its own scene, asked of drawn ones.

That makes sense of what may be said of many H, such as an order, or that |Λ| stays below a bound.
A formula in p and q, printed numbers, a region that is carried are those of one scene: such claims
are left out, each with the reason.
"""

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

from verify.claims.every_hamiltonian import of_hamiltonian
from verify.claims.findings import Findings
from verify.claims.judge import check_claim
from verify.claims.kinds import (
    EVERY_SEPARABLE,
    KINDS,
    AreaClaim,
    BoundedClaim,
    Claim,
    ConvergenceOrderClaim,
    CriteriaClaim,
    DeltaJClaim,
    FlowClaim,
    GrowthClaim,
    JacobianClaim,
    LessClaim,
    MonotoneClaim,
    OrderClaim,
    SpreadClaim,
    StepMapClaim,
    TheoremClaim,
)
from verify.claims.plan import add_claims
from verify.claims.scenes import ON_RUNS, scene_for
from verify.errors import InputError
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.execution.plan import Plan
from verify.exploration.property import Property, Violation
from verify.exploration.sample import Sample
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.verdict import Verdict

_NAME = "drawn"
_OF_ANY = (
    OrderClaim, ConvergenceOrderClaim, AreaClaim, MonotoneClaim, LessClaim, BoundedClaim,
    GrowthClaim, CriteriaClaim,
)  # fmt: skip


def why_not(claim: Claim) -> str:
    """Why other scenes cannot be asked what the claim says; empty where they can."""
    every = getattr(claim, "every", None)
    if every and isinstance(claim, AreaClaim) and not claim.area_preserving:
        return "that not every Hamiltonian has det J ≡ 1 says nothing of a single one"
    if isinstance(claim, _OF_ANY) or every:
        return ""
    if isinstance(claim, TheoremClaim):
        return "a theorem says nothing of drawn Hamiltonians"
    if isinstance(claim, StepMapClaim | JacobianClaim | DeltaJClaim):
        return "a printed formula is that of its own Hamiltonian"
    if isinstance(claim, FlowClaim):
        return "a region that is carried is that of its own scene"
    if isinstance(claim, SpreadClaim):
        return "a spread is over the initial values of its own scene"
    return "printed numbers are those of its own runs"


def claims_left_out(claims: Sequence[Claim]) -> dict[str, list[str]]:
    """The claims that cannot be asked of other scenes, by the reason."""
    found: dict[str, list[str]] = {}
    for claim in claims:
        if why := why_not(claim):
            found.setdefault(why, []).append(claim.id)
    return found


def claim_texts(claims: Sequence[Claim]) -> tuple[str, ...]:
    """Those that other scenes can be asked of, as tasks hold them. InputError where none can."""
    asked = [claim for claim in claims if not why_not(claim)]
    if not asked:
        raise InputError("claim", claims[0].id, f"{why_not(claims[0])}, and no other claim is left")
    return tuple(json.dumps(claim.model_dump(mode="json"), sort_keys=True) for claim in asked)


def scheme_of(text: str) -> str:
    """The scheme that the claim speaks of."""
    scheme: str = json.loads(text)["scheme"]
    return scheme


@lru_cache(maxsize=256)
def claim_property(text: str) -> Property:
    """The property that the claim makes; it is asked of its own scheme, whatever was drawn."""
    data: dict[str, Any] = json.loads(text)
    claim = KINDS[data["kind"]].model_validate(data)
    sentence = claim.statement or f"{claim.kind} of {claim.scheme}, as {claim.id} says"
    return Property(claim.id, sentence, lambda sample: _holds(claim, sample), claim.scheme)


def _holds(claim: Claim, sample: Sample) -> bool:
    """Raises Violation where the claim is refuted for the sample's H and run."""
    separable = getattr(claim, "every", None) == EVERY_SEPARABLE
    if separable and not sample.hamiltonian.field()[0].separable():
        return False
    asked = _of_scheme(sample, claim.scheme)
    if asked is None or not asked.ordinary:
        return False
    try:
        found = _verdict_on(claim, asked)
    except InputError:  # too long a formula, or an end of the run that cannot be had
        return False
    if found.verdict is Verdict.REFUTED:
        raise Violation(found.evidence)
    return found.verdict is not Verdict.UNDECIDED


def _of_scheme(sample: Sample, name: str) -> Sample | None:
    """The sample with that scheme; None where the scheme does not take its H."""
    scene = sample.scene.model_copy(update={"schemes": (name,), "name": _NAME})
    asked = replace(sample, scheme=get(name), scene=scene)
    try:
        _ = asked.step_map
    except InputError:
        return None
    return asked


def _verdict_on(claim: Claim, sample: Sample) -> Any:
    """The claim's result for the sample, a `verify.scenes.results.claim.ClaimResult`."""
    claim = claim.model_copy(update={"scene": _NAME} | _without_every(claim, sample))
    scenes = {_NAME: _scene(claim, sample)}
    plan = Plan()
    known = add_claims(plan, [claim], scenes)
    results = execute(plan, Store(None), where=THIS_PROCESS)
    return check_claim(claim, Findings(scenes, {**known, **results}))


def _without_every(claim: Claim, sample: Sample) -> dict[str, Any]:
    """What changes where a claim of every H is made of this one.

    An order that is not passed for all H together may well be passed for this one.
    """
    if not getattr(claim, "every", None):
        return {}
    if isinstance(claim, DeltaJClaim):
        return {"every": None, "formula": of_hamiltonian(claim, sample.hamiltonian)}
    if isinstance(claim, OrderClaim | ConvergenceOrderClaim):
        return {"every": None, "at_least": True}
    return {"every": None}


def _scene(claim: Claim, sample: Sample) -> Scene:
    """The sample's scene, with the runs that the claim speaks of."""
    scene = sample.scene
    if not isinstance(claim, ON_RUNS):
        return scene
    h = sample.step_size
    runs: dict[str, Any] = {"q": sample.q, "p": sample.p}
    if isinstance(claim, MonotoneClaim):  # it compares step sizes over one time
        runs |= {"step_sizes": (h / 2, h), "time": sample.steps * h}
    else:
        runs |= {"step_size": h, "steps": sample.steps}
    return scene_for(claim, {"scene": _NAME}, runs, lambda _: scene)[1]
