"""A claim as a property: what it says of its own scene, asked of drawn ones.

That makes sense of what may be said of many H, such as an order, or that |Λ| stays below a bound.
A formula in p and q, printed numbers, a region that is carried are those of one scene: such claims
are left out, each with the reason.
"""

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import Any

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.claims.judging import results_for
from verify.claims.kinds import models
from verify.claims.quantified import QuantifiedClaim
from verify.claims.scenes import scene_for
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

_NAME = "drawn"


def claims_left_out(claims: Sequence[Claim]) -> dict[str, list[str]]:
    """The claims that cannot be asked of other scenes, by the reason."""
    found: dict[str, list[str]] = {}
    for claim in claims:
        if why := claim.why_only_here():
            found.setdefault(why, []).append(claim.id)
    return found


def claim_texts(claims: Sequence[Claim]) -> tuple[str, ...]:
    """Those that other scenes can be asked of, as tasks hold them. InputError where none can."""
    asked = [claim for claim in claims if not claim.why_only_here()]
    if not asked:
        raise InputError(
            "claim", claims[0].id, f"{claims[0].why_only_here()}, and no other claim is left"
        )
    return tuple(json.dumps(claim.model_dump(mode="json"), sort_keys=True) for claim in asked)


def scheme_of(text: str) -> str:
    """The scheme that the claim speaks of.

    >>> scheme_of('{"kind": "order", "scheme": "lie2"}')
    'lie2'
    """
    scheme: str = json.loads(text)["scheme"]
    return scheme


@lru_cache(maxsize=256)
def claim_property(text: str) -> Property:
    """The property that the claim makes; it is asked of its own scheme, whatever was drawn."""
    data: dict[str, Any] = json.loads(text)
    claim = models()[data["kind"]].model_validate(data)
    sentence = (
        str(read_prose(claim.statement)) or f"{claim.kind} of {claim.scheme}, as {claim.id} says"
    )
    return Property(claim.id, sentence, partial(_check, claim), claim.scheme)


def _check(claim: Claim, sample: Sample) -> None:
    """Raises Violation where the claim is refuted for the sample's H and run; in n degrees of
    freedom of claims that algebra decides, as a run's are of the plane."""
    only_if(sample.light and (sample.most.runs or not claim.run_keys))
    separable = isinstance(claim, QuantifiedClaim) and claim.of_separable
    only_if(not separable or canonical_field(sample.hamiltonian)[0].separable)
    asked = _of_scheme(sample, claim.scheme)
    only_if(asked.ordinary)
    with silent_at(InputError):  # too long a formula, or an end of the run that cannot be had
        found = _verdict_on(claim, asked)
    if found.verdict is Verdict.REFUTED:
        raise Violation(found.evidence)
    only_if(found.verdict is not Verdict.UNDECIDED)


def _of_scheme(sample: Sample, name: str) -> Sample:
    """The sample with that scheme; Silent where the scheme does not take its H."""
    scene = sample.scene.model_copy(update={"schemes": (name,), "name": _NAME})
    asked = replace(sample, scheme=get(name), scene=scene)
    with silent_at(InputError):
        _ = asked.step_map
    return asked


def _verdict_on(claim: Claim, sample: Sample) -> ClaimResult:
    """The claim's result for the sample."""
    claim = claim.of_one(sample.hamiltonian).model_copy(update={"scene": _NAME})
    scenes = {_NAME: _scene(claim, sample)}
    results = results_for(claim, scenes, Store(None), THIS_PROCESS)
    return claim.judge(Findings(scenes, results))


def _scene(claim: Claim, sample: Sample) -> Scene:
    """The sample's scene, with the runs that the claim speaks of."""
    scene = sample.scene
    if not claim.run_keys:
        return scene
    start = {name: sample.run_arguments[name] for name in ("q", "p")}
    runs = {**start, **claim.drawn_runs(sample.step_size, sample.steps)}
    return scene_for(claim, {"scene": _NAME}, runs, lambda _: scene)[1]
