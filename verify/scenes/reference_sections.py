"""The section of a scene that asks for reference data: see `verify reference make`.

[[reference]]
step_sizes = [0.001, 0.01]
initial_values = [{ q = 1.5, p = 0 }]
steps = [0, 1, 10, 100, 1000]          # after which the state, ΔJ, MSE and Λ are given; ascending
digits = 30                            # of every number, correctly rounded
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
flow = true                            # the exact flow at the times N h, too
"""

from typing import Annotated, Self

from pydantic import Field, model_validator

from verify.errors import InputError
from verify.scenes.frozen import Frozen
from verify.scenes.values import InitialValue, StepSize

MOST_ROWS = 100_000  # of a section: they are held in memory, and checked one by one
_MOST_STEPS = 10**8
_MOST_DIGITS = 1000
Chosen = Annotated[int, Field(ge=0, le=_MOST_STEPS, strict=True)]


class Reference(Frozen):
    """See the module's text for the keys."""

    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=1, max_length=1000)]
    initial_values: Annotated[tuple[InitialValue, ...], Field(min_length=1, max_length=1000)]
    steps: Annotated[tuple[Chosen, ...], Field(min_length=1, max_length=1000)]
    digits: Annotated[int, Field(ge=1, le=_MOST_DIGITS, strict=True)] = 30
    schemes: Annotated[tuple[str, ...], Field(max_length=100)] = ()
    flow: Annotated[bool, Field(strict=True)] = True

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("step_sizes", "initial_values", "schemes"):
            given = getattr(self, name)
            if len(set(given)) < len(given):
                raise InputError(name, len(given), "one of them stands twice")
        if list(self.steps) != sorted(set(self.steps)):
            raise InputError("steps", list(self.steps), "must ascend")
        rows = len(self.step_sizes) * len(self.initial_values) * len(self.steps)
        if rows * max(1, len(self.schemes)) > MOST_ROWS:
            raise InputError("reference", rows, f"makes more than {MOST_ROWS} rows")
        return self
