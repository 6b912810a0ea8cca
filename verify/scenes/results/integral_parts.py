"""The change of a function of the state after a float64 run: truncation and rounding."""

from typing import Literal

from pydantic import Field

from verify.scenes.frozen import Frozen
from verify.scenes.results.bounded_value import Value

PARTS = ("truncation", "input", "trajectory", "evaluation", "working", "total")


class IntegralParts(Frozen):
    """I − I₀ at the end of a float64 run, by `observable`, and its parts.

    `values`, by `PARTS`: what is printed, `working`, is `truncation` and `total`, and this the
    rounding by its place, `input`, `trajectory` and `evaluation`. Empty unless `status` is
    "finished".
    """

    observable: str
    step_size: str
    steps: int
    status: Literal["finished", "unresolved"]
    values: dict[str, Value] = Field(default_factory=dict)
    error_kind: Literal["enclosed", "estimated"] = "estimated"
