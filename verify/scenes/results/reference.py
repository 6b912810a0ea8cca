"""An orbit and the exact flow at chosen steps, every number correctly rounded; for reference data.

A description here is what the published JSON Schema says of a key.
"""

from typing import Annotated, Literal

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


class OrbitRow(Frozen):
    """What is known after `step` steps but for its numbers."""

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


class OrbitPoint(OrbitRow):
    """What is known after `step` steps; the values are None unless `status` is "finished"."""

    p: Rounded | None = Field(description=f"{_P} after N steps")
    q: Rounded | None = Field(description=f"{_Q} after N steps")
    delta_j: Rounded | None = Field(
        description="ΔJ = det J − 1 of the step that begins at that state; null too where no "
        "step is defined there, or it is given by equations and det J is not known to be 1"
    )
    mse: Rounded | None = Field(
        description="(1/N) Σ ΔJ_k² over the steps k = 0 … N−1; null too where N is 0"
    )
    lam: Rounded | None = Field(
        alias="lambda", description="Λ = Π(1 + ΔJ_k) − 1 over the steps k = 0 … N−1"
    )


class OrbitResult(Frozen):
    """One scheme's orbit at the steps that were asked for."""

    points: tuple[OrbitPoint, ...]


class FlowRow(Frozen):
    """When a solution is looked at."""

    step: int = Field(ge=0, description="N, where the time is N·h")
    time: str = Field(description="the time N·h exactly: a decimal or a quotient")


class FlowPoint(FlowRow):
    """The exact solution at the time N·h; p and q are None unless `status` is "finished"."""

    status: Literal["finished", "blows up", "not followed"] = Field(
        description="finished: p and q are there; blows up: the exact solution has left every "
        "bound by then; not followed: it could not be had"
    )
    kind: KindOrNone
    p: Rounded | None = Field(description=f"{_P} at that time")
    q: Rounded | None = Field(description=f"{_Q} at that time")


class SolutionResult(Frozen):
    """The exact flow at the times that were asked for."""

    points: tuple[FlowPoint, ...]
