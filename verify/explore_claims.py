"""A claim as a property: what it says of its own scene, asked of drawn ones."""

import json
from functools import lru_cache
from typing import Any

from verify.check_claims import check_claim
from verify.claim_plan import add_claims
from verify.claim_scenes import ON_RUNS, scene_for
from verify.claims import KINDS, Claim, FlowClaim, TheoremClaim
from verify.errors import InputError
from verify.example import Example
from verify.execute import Store, execute
from verify.executors import HERE
from verify.findings import Findings
from verify.planned import Plan
from verify.property import Property, Violation
from verify.schemes import get
from verify.verdict import Verdict

_NAME = "drawn"


def claim_texts(claims: list[Claim]) -> tuple[str, ...]:
    """The claims as tasks hold them. Raises InputError for one that no other scene can be asked."""
    for claim in claims:
        if isinstance(claim, TheoremClaim | FlowClaim):
            said = f"is a {claim.kind} claim, which says nothing of other Hamiltonians"
            raise InputError("claim", claim.id, said)
    return tuple(json.dumps(claim.model_dump(mode="json"), sort_keys=True) for claim in claims)


def scheme_of(text: str) -> str:
    """The scheme that the claim speaks of."""
    scheme: str = json.loads(text)["scheme"]
    return scheme


@lru_cache(maxsize=256)
def claim_property(text: str) -> Property:
    """The property that the claim makes."""
    data: dict[str, Any] = json.loads(text)
    update = {"scene": _NAME} | ({"every": None} if "every" in data else {})
    claim = KINDS[data["kind"]].model_validate(data).model_copy(update=update)
    sentence = claim.statement or f"{claim.kind} of {claim.scheme}, as {claim.id} says"
    return Property(claim.id, sentence, lambda example: _holds(claim, example))


def _holds(claim: Claim, example: Example) -> bool:
    """Raises Violation where the claim is refuted for the example's H and run."""
    try:
        get(claim.scheme).step_map(example.hamiltonian)
    except InputError:  # the scheme does not take this H
        return False
    scene = example.scene.model_copy(update={"schemes": (claim.scheme,), "name": _NAME})
    if isinstance(claim, ON_RUNS):
        runs = {"step_size": example.step_size, "steps": example.steps,
                "q": example.q, "p": example.p}  # fmt: skip
        _, scene = scene_for(claim, {"scene": _NAME}, runs, lambda _: scene)
    scenes = {_NAME: scene}
    plan = Plan()
    known = add_claims(plan, [claim], scenes)
    results = execute(plan, Store(None), where=HERE)
    found = check_claim(claim, Findings(scenes, {**known, **results}))
    if found.verdict is Verdict.REFUTED:
        raise Violation(found.evidence)
    return found.verdict is not Verdict.UNDECIDED
