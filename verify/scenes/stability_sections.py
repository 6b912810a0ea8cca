"""Sections of a scene on the stability of its schemes.

[[stability]]                          # each run judged: stable, drifts, unstable and whose fault
name = "near the top"                  # part of the cases' names; may be left out
step_sizes = [0.1, 0.01]
time = 100                             # or steps = 5000
initial_values = [{ q = 3.1, p = 0 }]
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out

[[largest_step]]                       # the largest step with bounded motion, by bisection
time = 100
initial_value = { q = 1, p = 0 }
energy_error = 0.01                    # and with an energy kept to a hundredth of its scale
symplectic_defect = 1e-3               # and with |W|, in the plane |Λ|, below so much

[[stability_map]]                      # verdicts over step size and stiffness, a picture a scheme
parameter = "delta"
values = { from = 0.01, to = 1e12, count = 15 }  # as many, evenly on a logarithmic scale; or a list
step_sizes = { from = 1e-7, to = 10, count = 25 }
steps = 1000
initial_value = { q = 1, p = 0 }

[[orbit_map]]                          # regular, sensitive or leaving: a picture
axes = ["q2", "p2"]                    # which two initial values, to the right and upwards
across = { from = -0.5, to = 1, count = 40 }  # those of the first, evenly; or a list
upwards = { from = -0.5, to = 0.5, count = 40 }
initial_value = { q = [0, 0], p = [0.2, 0] }  # the others
step_size = 0.1
steps = 2000                           # or time = 200
schemes = ["lie2", "stormer-verlet"]   # the scene's, where it is left out
beyond = 10                            # what goes farther has left; 10 times the farthest start
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import Annotated, Self

from pydantic import BeforeValidator, Field, model_validator

from verify import schemes as scheme_catalogue
from verify.arithmetic.exact import decimal, positive, rational, text
from verify.arithmetic.systems import mpfr
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of
from verify.scenes.frozen import Section
from verify.scenes.values import (
    ExactNumber,
    SchemeName,
    Start,
    Steps,
    StepSize,
    Time,
    check_distinct,
    check_one_length,
    count_steps,
    read_range,
)

# The limit on the steps of a judged run, or of all orbits of a map together; they take minutes.
_MAX_STEPS = 10**9
_MAX_MAP_STEPS = 100_000
_MAX_CELLS = 10_000
# Significant digits of the values in a range.
_DIGITS = 3


def _space_logarithmically(low: Fraction, high: Fraction, count: int) -> Iterator[Fraction]:
    """Yield values evenly spaced on a logarithmic scale, to three digits."""
    # 20 digits suffice: the values are rounded to three, and are then exact inputs.
    arithmetic = mpfr.make(20)
    log, exp = (arithmetic.functions[name] for name in ("log", "exp"))
    with arithmetic.context():
        first, last = (log(arithmetic.number(x)) for x in (low, high))
        sizes = [exp(first + (last - first) * k / (count - 1)) for k in range(count)]
    for size in sizes:
        yield Fraction(decimal(arithmetic.exact(size), _DIGITS))


_SPREAD = BeforeValidator(lambda value: read_range(value, positive, _space_logarithmically))
Values = Annotated[tuple[ExactNumber, ...], _SPREAD, Field(min_length=1, max_length=200)]
StepSizes = Annotated[tuple[StepSize, ...], _SPREAD, Field(min_length=1, max_length=200)]
Schemes = Annotated[tuple[SchemeName, ...], Field(max_length=100)]


class OfSchemes(Section):
    """A section that may name its own schemes."""

    schemes: Schemes = ()
    """The schemes; the scene's, where it is left out."""

    @model_validator(mode="after")
    def _check_names(self) -> Self:
        for name in self.schemes:
            scheme_catalogue.get(name)
        check_distinct("schemes", self.schemes)
        return self


class Stability(OfSchemes):
    """Runs that are judged stable or not; see the module's text."""

    name: Annotated[str, Field(max_length=80)] = ""
    """Part of the names of its cases."""
    time: Time | None = None
    """The length of each run; or `steps`."""
    steps: Steps | None = None
    """The number of steps of each run; or `time`."""
    step_sizes: StepSizes
    """The step sizes; or `{ from = …, to = …, count = … }`, evenly by their logarithms."""
    initial_values: Annotated[tuple[Start, ...], Field(min_length=1, max_length=1000)]
    """Where the runs start."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_one_length(self.time, self.steps)
        for h in self.step_sizes:
            self.steps_for(h)
        return self

    def steps_for(self, h: Fraction) -> int:
        """Return N: the number of steps, or the whole steps of size h that fit into `time`."""
        return count_steps(self.time, self.steps, h, _MAX_STEPS)


class LargestStepOver(OfSchemes):
    """A search for the largest step size with bounded motion; see the module's text."""

    time: Time
    """Until when the motion is to stay bounded."""
    initial_value: Start
    """Where the runs start."""
    energy_error: ExactNumber | None = None
    """The greatest |H − H(z0)| that is allowed, in parts of the orbit's energy scale."""
    symplectic_defect: ExactNumber | None = None
    """The greatest |entry| of W that is allowed, the symplectic defect of all steps; in the plane
    |Λ|."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        for name in ("energy_error", "symplectic_defect"):
            limit = getattr(self, name)
            if limit is not None and limit <= 0:
                raise InputError(name, text(limit), "must be greater than 0")
        return self


class StabilityMap(OfSchemes):
    """Verdicts over step size and one parameter of H; see the module's text."""

    parameter: str
    """The parameter of H that is varied."""
    values: Values
    """Its values; or `{ from = …, to = …, count = … }`, evenly by their logarithms."""
    step_sizes: StepSizes
    """The step sizes, likewise."""
    steps: Annotated[int, Field(ge=1, le=_MAX_MAP_STEPS, strict=True)]
    """The number of steps of each run."""
    initial_value: Start
    """Where the runs start."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        cells = len(self.values) * len(self.step_sizes)
        if cells > _MAX_CELLS:
            raise InputError("values, step_sizes", cells, f"cells; allowed: {_MAX_CELLS}")
        return self


def _space_evenly(low: Fraction, high: Fraction, count: int) -> Iterator[Fraction]:
    return (low + (high - low) * k / (count - 1) for k in range(count))


Evenly = Annotated[
    tuple[ExactNumber, ...],
    BeforeValidator(lambda value: read_range(value, rational, _space_evenly)),
    Field(min_length=1, max_length=200),
]


class OrbitMap(Section):
    """Kinds of orbits over two of their initial values; see the module's text."""

    axes: tuple[str, str]
    """The two initial values that are varied: to the right, and upwards."""
    across: Evenly
    """The values of the first; or `{ from = …, to = …, count = … }`, evenly."""
    upwards: Evenly
    """The values of the second, likewise."""
    initial_value: Start
    """Where the orbits start but for these two."""
    step_size: StepSize
    """The step size h."""
    time: Time | None = None
    """How long each orbit is followed, N = T/h rounded down; or `steps`."""
    steps: Steps | None = None
    """Over how many steps it is; or `time`."""
    schemes: Annotated[tuple[SchemeName, ...], Field(max_length=100)] = ()
    """The schemes; the scene's, where it is left out."""
    beyond: ExactNumber | None = None
    """An orbit has left where a coordinate is greater than this in size; ten times the greatest
    coordinate of any start, where it is left out."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_one_length(self.time, self.steps)
        for name in ("axes", "across", "upwards", "schemes"):
            check_distinct(name, getattr(self, name))
        for scheme in self.schemes:
            scheme_catalogue.get(scheme)
        cells = len(self.across) * len(self.upwards)
        if cells > _MAX_CELLS:
            raise InputError("across, upwards", cells, f"cells; allowed: {_MAX_CELLS}")
        if cells * self.count > _MAX_STEPS:
            raise InputError("steps", self.count, f"of {cells} cells are more than {_MAX_STEPS}")
        if self.beyond is not None and self.beyond <= 0:
            raise InputError("beyond", text(self.beyond), "must be greater than 0")
        return self

    @property
    def count(self) -> int:
        """The number N of steps of each orbit."""
        return count_steps(self.time, self.steps, self.step_size)

    def farthest(self, hamiltonian: Hamiltonian) -> Fraction:
        """Return the size of a coordinate beyond which an orbit has left."""
        if self.beyond is not None:
            return self.beyond
        point = point_of(hamiltonian, self.initial_value.q, self.initial_value.p)
        fixed_values = (x for name, x in point.items() if name not in self.axes)
        # An orbit that starts at the origin has the bound 10.
        return 10 * max(map(abs, (*fixed_values, *self.across, *self.upwards))) or Fraction(10)

    def check_hamiltonian(self, hamiltonian: Hamiltonian) -> None:
        """Raise InputError if H has no such coordinate."""
        names = hamiltonian.coordinates
        for name in self.axes:
            if name not in names:
                raise InputError("axes", name, f"is no coordinate; allowed: {', '.join(names)}")
