"""An orbit and the exact flow in n degrees of freedom at chosen steps, every number correctly
rounded; as `verify.scenes.results.reference` in the plane.

A description here is what the published JSON Schema says of a key.
"""

from typing import Literal

from pydantic import Field

from verify.scenes.frozen import Frozen
from verify.scenes.results.reference import FlowRow, KindOrNone, OrbitRow, Rounded

_ENTRIES = "an entry of its matrix in p1 … pn, q1 … qn"
_EACH_P, _EACH_Q = "the momenta p1 … pn", "the displacements q1 … qn"
Each = tuple[Rounded, ...] | None


class OrbitPointInDegrees(OrbitRow):
    """What is known after `step` steps; the values are None unless `status` is "finished"."""

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


class FlowPointInDegrees(FlowRow):
    """The exact solution at the time N·h; p and q are None unless `status` is "finished"."""

    status: Literal["finished", "not followed"] = Field(
        description="finished: p and q are there; not followed: they could not be had"
    )
    kind: KindOrNone
    p: Each = Field(description=f"{_EACH_P} at that time")
    q: Each = Field(description=f"{_EACH_Q} at that time")


class SolutionInDegreesResult(Frozen):
    """The exact flow at the times that were asked for."""

    points: tuple[FlowPointInDegrees, ...]
