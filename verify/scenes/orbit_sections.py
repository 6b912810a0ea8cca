"""Sections of a scene on points of orbits: once in each period of H, and Poincaré sections.

[[stroboscopic]]                       # states at multiples of a period, in the (q, p) plane
period = 1                             # of H in t, a whole number of steps
step_size = 0.01
periods = 500
initial_values = [{ q = 1, p = 0 }, { q = 0.5, p = 0 }]
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
digits = 33                            # with which orbits are followed
source = "Figure 6"                    # what of a paper it repeats; may be left out

[[poincare]]                           # of an autonomous H(p1 … pn, q1 … qn), n ≥ 2
coordinate = "q1"                      # which passes …
value = 0                              # … this value
rising = true                          # upwards; false: downwards
draw = ["q2", "p2"]                    # what is drawn: to the right, and upwards
step_size = 0.05
time = 500                             # how long each orbit is followed; or steps = 10000
initial_values = [{ q = [0, 0.1], p = [0.4, 0] }, { q = [0, 0], p = [0.5, 0] }]
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
exact = true                           # the exact flow's points beside them
digits = 33                            # with which orbits by schemes are followed
source = "Figure 4"                    # what of a paper it repeats; may be left out
"""

from fractions import Fraction
from typing import Annotated, Self

from pydantic import Field, model_validator

from verify.arithmetic.exact import text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import check_period
from verify.scenes.frozen import Section
from verify.scenes.values import (
    Digits,
    ExactNumber,
    InitialValue,
    SchemeName,
    Start,
    Steps,
    StepSize,
    Time,
    check_distinct,
    check_one_length,
    count_steps,
)

_MAX_PERIODS, _MAX_POINTS, _MAX_STEPS = 10_000, 20_000, 10**8
# The limit on the steps of all orbits by one map together; they take minutes.
_MAX_PASSING_STEPS = 2_000_000


class Stroboscopic(Section):
    """Orbits looked at once in each period of H in t; see the module's text."""

    period: StepSize
    """The time between two looks: a period of H in t, and a whole number of steps."""
    step_size: StepSize
    """The step size h."""
    periods: Annotated[int, Field(ge=1, le=_MAX_PERIODS, strict=True)]
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
        """The number of steps in one period."""
        return int(self.period / self.step_size)

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("initial_values", "schemes"):
            check_distinct(name, getattr(self, name))
        # The phase of the drive would move if a period were no whole number of steps.
        count = Fraction(self.period / self.step_size)
        if count.denominator != 1:
            problem = f"is no whole number of steps of {text(self.step_size)}: {text(count)}"
            raise InputError("period", text(self.period), problem)
        if self.periods * len(self.initial_values) > _MAX_POINTS:
            problem = f"with {len(self.initial_values)} orbits, of {_MAX_POINTS} points at most"
            raise InputError("periods", self.periods, problem)
        if self.periods * count > _MAX_STEPS:
            raise InputError("periods", self.periods, f"are more than {_MAX_STEPS} steps")
        return self

    def check_hamiltonian(self, hamiltonian: Hamiltonian) -> None:
        """Raise InputError if H at t + period is another function than at t."""
        check_period(hamiltonian, self.period)


class Poincare(Section):
    """Orbits looked at where they pass a surface in phase space; see the module's text."""

    coordinate: str = "q1"
    """The coordinate whose passing of `value` is looked at, one of p1 … pn, q1 … qn."""
    value: ExactNumber = Fraction(0)
    """The value that it passes."""
    rising: Annotated[bool, Field(strict=True)] = True
    """Whether it passes upwards, or, where this is false, downwards."""
    draw: tuple[str, str] = ("q2", "p2")
    """The two coordinates that are drawn, to the right and upwards."""
    step_size: StepSize
    """The step size h."""
    time: Time | None = None
    """How long the orbits are followed, N = T/h rounded down; or `steps`."""
    steps: Steps | None = None
    """Over how many steps they are; or `time`."""
    initial_values: Annotated[tuple[Start, ...], Field(min_length=1, max_length=100)]
    """Where the orbits start, each once, with lists; each has its own energy."""
    schemes: Annotated[tuple[SchemeName, ...], Field(max_length=100)] = ()
    """The schemes; the scene's, where it is left out."""
    exact: Annotated[bool, Field(strict=True)] = True
    """Whether the exact flow's points stand beside them."""
    digits: Digits = 33
    """With how many digits the orbits by schemes are followed."""
    source: Annotated[str, Field(max_length=80)] = ""
    """What of a paper it repeats, for its caption."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_one_length(self.time, self.steps)
        for name in ("initial_values", "schemes", "draw"):
            check_distinct(name, getattr(self, name))
        if self.count * len(self.initial_values) > _MAX_PASSING_STEPS:
            problem = (
                f"for {len(self.initial_values)} orbits are more than {_MAX_PASSING_STEPS} in all"
            )
            raise InputError("steps", self.count, problem)
        return self

    @property
    def count(self) -> int:
        """The number N of steps of each orbit."""
        return count_steps(self.time, self.steps, self.step_size)

    def check_hamiltonian(self, hamiltonian: Hamiltonian) -> None:
        """Raise InputError if H depends on t, is planar, or lacks one of the coordinates."""
        formula, names = hamiltonian.formula, hamiltonian.coordinates
        if hamiltonian.degrees < 2:
            problem = "is of one degree of freedom; [[poincare]] takes p1 … pn and q1 … qn, n ≥ 2"
            raise InputError("hamiltonian", formula, problem)
        if hamiltonian.time_dependent:
            problem = "depends on t; [[poincare]] takes an H that does not"
            raise InputError("hamiltonian", formula, problem)
        for key, name in (("coordinate", self.coordinate), *(("draw", x) for x in self.draw)):
            if name not in names:
                raise InputError(key, name, f"is no coordinate; allowed: {', '.join(names)}")
