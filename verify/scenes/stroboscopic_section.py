"""The section of a scene that looks at orbits once in each period of H.

[[stroboscopic]]                       # states at multiples of a period, in the (q, p) plane
period = 1                             # of H in t, a whole number of steps
step_size = 0.01
periods = 500
initial_values = [{ q = 1, p = 0 }, { q = 0.5, p = 0 }]
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
digits = 33                            # with which orbits are followed
source = "Figure 6"                    # what of a paper it repeats; may be left out
"""

from fractions import Fraction
from typing import Annotated, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import check_period
from verify.scenes.frozen import Section
from verify.scenes.values import Digits, InitialValue, SchemeName, StepSize, distinct

_MOST_PERIODS, _MOST_POINTS, _MOST_STEPS = 10_000, 20_000, 10**8


class Stroboscopic(Section):
    """See the module's text for the keys."""

    period: StepSize
    """The time between two looks: a period of H in t, and a whole number of steps."""
    step_size: StepSize
    """The step size h."""
    periods: Annotated[int, Field(ge=1, le=_MOST_PERIODS, strict=True)]
    """How many periods the orbits last."""
    initial_values: Annotated[tuple[InitialValue, ...], Field(min_length=1, max_length=100)]
    """Where the orbits start, each once."""
    schemes: Annotated[tuple[SchemeName, ...], Field(max_length=100)] = ()
    """The schemes; the scene's, where it is left out."""
    digits: Digits = 33
    """With how many digits the orbits are followed."""
    source: Annotated[str, Field(max_length=80)] = ""
    """What of a paper it repeats, for its caption."""

    @property
    def steps(self) -> int:
        """Of one period."""
        return int(self.period / self.step_size)

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("initial_values", "schemes"):
            distinct(name, getattr(self, name))
        count = Fraction(self.period / self.step_size)
        if count.denominator != 1:
            shown = f"is no whole number of steps of {text(self.step_size)}: {text(count)}"
            raise InputError("period", text(self.period), shown)
        if self.periods * len(self.initial_values) > _MOST_POINTS:
            problem = f"with {len(self.initial_values)} orbits, of {_MOST_POINTS} points at most"
            raise InputError("periods", self.periods, problem)
        if self.periods * count > _MOST_STEPS:
            raise InputError("periods", self.periods, f"are more than {_MOST_STEPS} steps")
        return self

    def check_hamiltonian(self, hamiltonian: Hamiltonian) -> None:
        """InputError where H at t + period is another function than at t."""
        check_period(hamiltonian, self.period)
