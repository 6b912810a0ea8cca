"""An orbit and the exact flow at chosen steps, every number correctly rounded; for reference data.

In the plane p and q are a number each, in n degrees of freedom a list each. A description here is
what the published JSON Schema says of a key.
"""

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from verify.scenes.frozen import Frozen

_DECIMAL = r"^-?[0-9](\.[0-9]+)?(e[+-][0-9]{2,})?$"
Decimal = Annotated[str, Field(pattern=_DECIMAL)]
Kind = Literal["enclosed", "estimated"]

KindOrNone = Annotated[
    Kind | None,
    Field(
        description="enclosed: the radii are rigorous bounds; estimated: they hold unless an "
        "evaluation with more digits errs as the first did; null where there are no values"
    ),
]
_P, _Q = "the momentum p", "the displacement q"
_EACH_P, _EACH_Q = "the momenta p1 … pn", "the displacements q1 … qn"
_ENTRIES = "an entry of its matrix in p1 … pn, q1 … qn"


class Rounded(Frozen):
    """A number: the decimal nearest to it of so many digits, and how far from it that may be."""

    value: Decimal = Field(
        description="the number, correctly rounded to the digits asked for: one digit, a "
        "point, digits, e and the exponent; 0 where it is 0, or smaller than the radius"
    )
    radius: Decimal = Field(
        description="half a unit of the value's last place; 0 where the value is exact; for a "
        "value of 0 that is not exact, 10 to minus twice the digits, p and q in units of "
        "their initial values"
    )


Cell = Rounded | None
Cells = tuple[Rounded, ...] | None


class OrbitRow(Frozen):
    """The keys of a row after `step` steps, without the observables beside the state."""

    model_config = ConfigDict(populate_by_name=True)

    step: int = Field(
        ge=0, description="N: how many steps of size h have been done; 0 is the initial value"
    )
    status: Literal["finished", "left range", "unresolved"] = Field(
        description="finished: the values are there; left range: the scheme's orbit has passed "
        "2^4000, or is not defined any more; unresolved: the digits asked for could not be had"
    )
    failed_step: int | None = Field(
        description="the step that left the range, 1 being the first; else null"
    )
    kind: KindOrNone
    p: Any
    q: Any


class OrbitPoint(OrbitRow):
    """What is known after `step` steps; the values are None unless `status` is "finished"."""

    p: Cell = Field(description=f"{_P} after N steps")
    q: Cell = Field(description=f"{_Q} after N steps")
    delta_j: Cell = Field(
        description="ΔJ = det J − 1 of the step that begins at that state; null too where no "
        "step is defined there, or it is given by equations and det J is not known to be 1"
    )
    mse: Cell = Field(description="(1/N) Σ ΔJ_k² over the steps k = 0 … N−1; null too where N is 0")
    lam: Cell = Field(alias="lambda", description="Λ = Π(1 + ΔJ_k) − 1 over the steps k = 0 … N−1")


class OrbitPointInDegrees(OrbitRow):
    """What is known after `step` steps; the values are None unless `status` is "finished"."""

    p: Cells = Field(description=f"{_EACH_P} after N steps")
    q: Cells = Field(description=f"{_EACH_Q} after N steps")
    energy: Cell = Field(
        description="H at that state, and at the time t0 + N h where it depends on time; null too "
        "where H is not defined there"
    )
    symplectic_defect_max: Cell = Field(
        description=f"S = JᵀΩJ − Ω, J being ∂z after a step by ∂z before it, Ω = Σ dp_i∧dq_i: the "
        f"greatest |{_ENTRIES}| of any of the steps k = 0 … N−1; null too where N is 0"
    )
    symplectic_defect: Cell = Field(
        description="W = MᵀΩM − Ω, M being ∂z after N steps by ∂z at the start: the greatest "
        f"|{_ENTRIES}|"
    )
    lam: Cell = Field(alias="lambda", description="Λ = Π det J_k − 1 over the steps k = 0 … N−1")


class OrbitResult(Frozen):
    """The orbit of one scheme at the requested steps."""

    points: tuple[OrbitPoint | OrbitPointInDegrees, ...]


class FlowRow(Frozen):
    """The exact solution at the time N·h; p and q are None unless `status` is "finished"."""

    step: int = Field(ge=0, description="N, where the time is N·h")
    time: str = Field(description="the time N·h exactly: a decimal or a quotient")
    status: str
    kind: KindOrNone
    p: Any
    q: Any


class FlowPoint(FlowRow):
    """The exact solution at the time N·h; p and q are None unless `status` is "finished"."""

    status: Literal["finished", "blows up", "not followed"] = Field(
        description="finished: p and q are there; blows up: the exact solution has left every "
        "bound by then; not followed: it could not be had"
    )
    p: Cell = Field(description=f"{_P} at that time")
    q: Cell = Field(description=f"{_Q} at that time")


class FlowPointInDegrees(FlowRow):
    """The exact solution at the time N·h; p and q are None unless `status` is "finished"."""

    status: Literal["finished", "not followed"] = Field(
        description="finished: p and q are there; not followed: they could not be had"
    )
    p: Cells = Field(description=f"{_EACH_P} at that time")
    q: Cells = Field(description=f"{_EACH_Q} at that time")


class SolutionResult(Frozen):
    """The exact flow at the requested times."""

    points: tuple[FlowPoint | FlowPointInDegrees, ...]
