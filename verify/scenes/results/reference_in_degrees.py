"""An orbit and the exact flow in n degrees of freedom at chosen steps, every number correctly
rounded; as `verify.scenes.results.reference` in the plane.

A description here is what the published JSON Schema says of a key.
"""

from typing import Literal

from pydantic import ConfigDict, Field

from verify.scenes.frozen import Frozen
from verify.scenes.results.reference import KIND_SAID, STEP_SAID, Kind, Rounded

_ENTRIES = "an entry of its matrix in p1 … pn, q1 … qn"
_EACH_P, _EACH_Q = "the momenta p1 … pn", "the displacements q1 … qn"
Each = tuple[Rounded, ...] | None


class OrbitPointInDegrees(Frozen):
    """What is known after `step` steps; the values are None unless `status` is "finished"."""

    model_config = ConfigDict(populate_by_name=True)

    step: int = Field(ge=0, description=STEP_SAID)
    status: Literal["finished", "left range", "unresolved"] = Field(
        description="finished: the values are there; left range: the scheme's orbit has passed "
        "2^4000, or is not defined any more; unresolved: the digits asked for could not be had"
    )
    failed_step: int | None = Field(
        description="the step that left the range, 1 being the first; else null"
    )
    kind: Kind | None = Field(description=f"{KIND_SAID}; null where there are no values")
    p: Each = Field(description=f"{_EACH_P} after N steps")
    q: Each = Field(description=f"{_EACH_Q} after N steps")
    energy: Rounded | None = Field(
        description="H at that state, and at the time t0 + N h where it depends on time; null too "
        "where H is not defined there"
    )
    symplectic_defect_max: Rounded | None = Field(
        description=f"S = JᵀΩJ − Ω, J being ∂z after a step by ∂z before it, Ω = Σ dp_i∧dq_i: the "
        f"greatest |{_ENTRIES}| of any of the steps k = 0 … N−1; null too where N is 0"
    )
    symplectic_defect: Rounded | None = Field(
        description="W = MᵀΩM − Ω, M being ∂z after N steps by ∂z at the start: the greatest "
        f"|{_ENTRIES}|"
    )
    lam: Rounded | None = Field(
        alias="lambda", description="Λ = Π det J_k − 1 over the steps k = 0 … N−1"
    )


class OrbitInDegreesResult(Frozen):
    """One scheme's orbit at the steps that were asked for."""

    points: tuple[OrbitPointInDegrees, ...]


class FlowPointInDegrees(Frozen):
    """The exact solution at the time N·h; p and q are None unless `status` is "finished"."""

    step: int = Field(ge=0, description="N, where the time is N·h")
    time: str = Field(description="the time N·h exactly: a decimal or a quotient")
    status: Literal["finished", "not followed"] = Field(
        description="finished: p and q are there; not followed: they could not be had"
    )
    kind: Kind | None = Field(description=f"{KIND_SAID}; null where there are no values")
    p: Each = Field(description=f"{_EACH_P} at that time")
    q: Each = Field(description=f"{_EACH_Q} at that time")


class SolutionInDegreesResult(Frozen):
    """The exact flow at the times that were asked for."""

    points: tuple[FlowPointInDegrees, ...]
