"""Sections of a scene on runs of its schemes: a grid, separations, series, work and reference data.

[work_precision]                       # error against run time
time = 20                              # N is T/h, rounded down
step_sizes = [0.1, 0.05, 0.025]
initial_value = { q = 1.5, p = 0 }
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
repeats = 5                            # timings of each point
number_systems = ["fixed", "mpfr"]     # certified digits against run time, of one scheme
digits = [33, 53]
number_systems_scheme = "lie2"         # the first of the schemes, where it is left out
number_systems_step_size = 0.05        # the middle one, where it is left out
peers = false                          # true: they must be installed; else drawn where they are

[[reference]]                          # numbers to test against; see `verify reference make`
step_sizes = [0.001, 0.01]
initial_values = [{ q = 1.5, p = 0 }]
steps = [0, 1, 10, 100, 1000]          # after which the state, ΔJ, MSE and Λ are given; ascending
digits = 30                            # of every number, correctly rounded
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
flow = true                            # the exact flow at the times N h, too
"""

from fractions import Fraction
from functools import cached_property
from typing import Annotated, Self

from pydantic import Field, model_validator

from verify import observables
from verify import schemes as scheme_catalogue
from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.scenes.frozen import Section
from verify.scenes.values import (
    AUTO,
    AnyStart,
    ArithmeticName,
    Digits,
    InitialValue,
    SchemeName,
    Start,
    Steps,
    StepSize,
    Time,
    auto_for_digits,
    check_distinct,
    check_one_length,
    count_steps,
)


class Grid(Section):
    """Runs of every scheme for every step size and initial value, over `time` or `steps`."""

    time: Time | None = None
    """The length T of each run, N = T/h rounded down; or `steps`."""
    steps: Steps | None = None
    """The number N of steps of each run; or `time`."""
    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=1, max_length=1000)]
    """The step sizes h, each once."""
    initial_values: Annotated[tuple[AnyStart, ...], Field(min_length=1, max_length=1000)]
    """Where the runs start, such as `{ q = 1.5, p = 0 }`, each once; in n degrees of freedom lists,
    such as `{ q = [0.3, -0.1], p = [0.1, 0.2] }`; of a field by name, as `{ u = 1, v = 2 }`."""
    arithmetic: ArithmeticName = "float64"
    """The number system; `auto` where `digits` stand and this does not."""
    digits: Digits = 17
    """Significant digits that are asked for."""
    observables: tuple[str, ...] | None = None
    """What is computed: `delta_j_max`, `mse`, `lambda`, `lambda_plain`, `lambda_max`,
    `energy_error_max`; in n degrees of freedom also `symplectic_defect_max` and
    `symplectic_defect`. Left out: ΔJ, MSE and Λ, and these two."""
    separate: bool = False
    """Whether truncation is separated from rounding in Λ of each of these runs; in n degrees of
    freedom in W."""
    growth: bool = False
    """Whether Λ of each of these runs is held against its growth law."""
    growth_explains: Annotated[str, Field(max_length=200)] = ""
    """What of a paper the growth law explains, for the page."""

    _auto = model_validator(mode="before")(auto_for_digits)

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_one_length(self.time, self.steps)
        for name in self.observables or ():
            if observables.find(name) is None:
                raise unknown_name("observable", name, observables.by_name())
        if self.growth and self.observables and "lambda" not in self.observables:
            raise InputError("growth", self.growth, "wants lambda among the observables")
        check_distinct("step_sizes", self.step_sizes)
        if len(set(self.initial_values)) < len(self.initial_values):
            raise InputError(
                "initial_values", len(self.initial_values), "one of them stands twice; leave it out"
            )
        for h in self.step_sizes:
            self.steps_for(h)
        return self

    def steps_for(self, h: Fraction) -> int:
        """Return N: the number of steps, or the whole steps of size h that fit into `time`."""
        return count_steps(self.time, self.steps, h)

    @property
    def in_the_plane(self) -> tuple[InitialValue, ...]:
        """The initial values in one degree of freedom, for computations that exist there alone."""
        return tuple(at for at in self.initial_values if isinstance(at, InitialValue))

    @property
    def runs(self) -> int:
        """The number of runs of one scheme."""
        return len(self.step_sizes) * len(self.initial_values)

    @cached_property
    def steps_in_all(self) -> int:
        """The number of steps of all runs of one scheme."""
        return sum(map(self.steps_for, self.step_sizes)) * len(self.initial_values)


class SeparationOver(Section):
    """Truncation and rounding in Λ over step sizes, from one initial value; `time` or `steps`.

    In n degrees of freedom it is W, the symplectic defect of all steps, instead of Λ.
    """

    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=2, max_length=1000)]
    """The step sizes h over which the two are compared."""
    initial_value: Start
    """Where the runs start; in n degrees of freedom with lists."""
    time: Time | None = None
    """The length of each run; or `steps`."""
    steps: Steps | None = None
    """The number of steps of each run; or `time`."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        self.as_grid()
        return self

    def as_grid(self) -> Grid:
        """Return the section as a grid, which checks its values."""
        return Grid(
            time=self.time,
            steps=self.steps,
            step_sizes=self.step_sizes,
            initial_values=(self.initial_value,),
        )


class PlottedSeries(Section):
    """A run that is stored as a thinned series of at most `points` points.

    `source`: the part of a paper that it repeats, for a caption; no result depends on it.
    """

    step_size: StepSize
    """The step size h."""
    initial_value: AnyStart
    """Where the run starts; in n degrees of freedom with lists, of a field by name."""
    time: Time | None = None
    """The length of the run; or `steps`."""
    steps: Steps | None = None
    """The number of its steps; or `time`."""
    points: Annotated[int, Field(ge=2, le=5000, strict=True)] = 600
    """At most so many points of the run are kept."""
    arithmetic: ArithmeticName = "float64"
    """The number system; `auto` where `digits` stand and this does not."""
    digits: Digits = 17
    """Significant digits that are asked for."""
    source: Annotated[str, Field(max_length=80)] = ""
    """What of a paper it repeats, for its caption."""

    _auto = model_validator(mode="before")(auto_for_digits)

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_one_length(self.time, self.steps)
        count_steps(self.time, self.steps, self.step_size)
        return self

    @property
    def count(self) -> int:
        return count_steps(self.time, self.steps, self.step_size)


# The limit on the steps of a run that is timed several times.
MOST_STEPS = 10**8


class WorkPrecision(Section):
    """Error against run time of schemes, over step sizes; see the module's text."""

    time: Time
    """The length T of each run, N = T/h rounded down; the error is that at t = N·h."""
    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=2, max_length=100)]
    """The step sizes h, each once."""
    initial_value: Start
    """Where the runs start."""
    schemes: Annotated[tuple[SchemeName, ...], Field(max_length=100)] = ()
    """The schemes that are compared; the scene's, where it is left out."""
    repeats: Annotated[int, Field(ge=1, le=1000, strict=True)] = 5
    """Timings of each point, of which the median is told."""
    number_systems: tuple[ArithmeticName, ...] = ()
    """Certified digits against run time in these; then `digits` too."""
    digits: Annotated[tuple[Digits, ...], Field(max_length=100)] = ()
    """Digits that these number systems are asked for."""
    number_systems_scheme: SchemeName | None = None
    """Their scheme; the first of the schemes, where it is left out."""
    number_systems_step_size: StepSize | None = None
    """Their step size; the middle one, where it is left out."""
    peers: bool | None = None
    """Whether others' solvers stand beside; where it is left out, those installed do."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("step_sizes", "schemes", "number_systems", "digits"):
            check_distinct(name, getattr(self, name))
        step_size = self.number_systems_step_size
        # Each step size must make a permitted number of steps, also that of the number systems.
        for h in (*self.step_sizes, *(() if step_size is None else (step_size,))):
            self.steps_for(h)
        if bool(self.number_systems) != bool(self.digits):
            raise InputError("number_systems, digits", NOT_GIVEN, "give both or neither")
        if AUTO in self.number_systems:
            raise InputError("number_systems", AUTO, "name the number systems themselves")
        if self.number_systems_scheme is not None:
            scheme_catalogue.get(self.number_systems_scheme)
        return self

    def steps_for(self, h: Fraction) -> int:
        """Return N = T/h, rounded down; the error is that at t = N·h."""
        return count_steps(self.time, None, h, MOST_STEPS)


# The limit on a section's rows, which are held in memory and checked one by one.
MOST_ROWS = 100_000
_MOST_STEPS = 10**8
_MOST_DIGITS = 1000
Chosen = Annotated[int, Field(ge=0, le=_MOST_STEPS, strict=True)]


class Reference(Section):
    """Reference data: states and defects after chosen numbers of steps; see the module's text."""

    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=1, max_length=1000)]
    """The step sizes h, each once."""
    initial_values: Annotated[tuple[Start, ...], Field(min_length=1, max_length=1000)]
    """Where the runs start, each once; in n degrees of freedom with lists."""
    steps: Annotated[tuple[Chosen, ...], Field(min_length=1, max_length=1000)]
    """After how many steps the state, ΔJ, MSE and Λ are given; ascending. In n degrees of freedom
    the state, H, S, W and Λ."""
    digits: Annotated[int, Field(ge=1, le=_MOST_DIGITS, strict=True)] = 30
    """Significant digits of every number, correctly rounded."""
    schemes: Annotated[tuple[SchemeName, ...], Field(max_length=100)] = ()
    """The schemes; the scene's, where it is left out."""
    flow: Annotated[bool, Field(strict=True)] = True
    """Whether the exact flow at the times N·h is given, too."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("step_sizes", "initial_values", "schemes"):
            check_distinct(name, getattr(self, name))
        if list(self.steps) != sorted(set(self.steps)):
            raise InputError("steps", list(self.steps), "must ascend")
        rows = len(self.step_sizes) * len(self.initial_values) * len(self.steps)
        if rows * max(1, len(self.schemes)) > MOST_ROWS:
            raise InputError("reference", rows, f"makes more than {MOST_ROWS} rows")
        return self
