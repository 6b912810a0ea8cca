"""The section of a scene that asks what orbits do over two of their initial values.

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
from verify.arithmetic.exact import rational, text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import point_of
from verify.scenes.frozen import Section
from verify.scenes.values import (
    Number,
    SchemeName,
    Start,
    Steps,
    StepSize,
    Time,
    distinct,
    one_length,
    read_range,
    steps_of,
)

_MOST_CELLS, _MOST_STEPS = 10_000, 10**9  # the steps of all cells: minutes


def _evenly(low: Fraction, high: Fraction, count: int) -> Iterator[Fraction]:
    return (low + (high - low) * k / (count - 1) for k in range(count))


Evenly = Annotated[
    tuple[Number, ...],
    BeforeValidator(lambda given: read_range(given, rational, _evenly)),
    Field(min_length=1, max_length=200),
]


class OrbitMap(Section):
    """See the module's text for the keys."""

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
    beyond: Number | None = None
    """An orbit has left where a coordinate is greater than this in size; ten times the greatest
    coordinate of any start, where it is left out."""

    @model_validator(mode="after")
    def _check(self) -> Self:
        one_length(self.time, self.steps)
        for name in ("axes", "across", "upwards", "schemes"):
            distinct(name, getattr(self, name))
        for scheme in self.schemes:
            scheme_catalogue.get(scheme)
        cells = len(self.across) * len(self.upwards)
        if cells > _MOST_CELLS:
            raise InputError("across, upwards", cells, f"cells; allowed: {_MOST_CELLS}")
        if cells * self.count > _MOST_STEPS:
            raise InputError("steps", self.count, f"of {cells} cells are more than {_MOST_STEPS}")
        if self.beyond is not None and self.beyond <= 0:
            raise InputError("beyond", text(self.beyond), "must be greater than 0")
        return self

    @property
    def count(self) -> int:
        """The number N of steps of each orbit."""
        return steps_of(self.time, self.steps, self.step_size)

    def farthest(self, hamiltonian: Hamiltonian) -> Fraction:
        """Beyond which an orbit has left."""
        if self.beyond is not None:
            return self.beyond
        point = point_of(hamiltonian, self.initial_value.q, self.initial_value.p)
        rest = (x for name, x in point.items() if name not in self.axes)
        return 10 * max(map(abs, (*rest, *self.across, *self.upwards))) or Fraction(10)

    def check_hamiltonian(self, hamiltonian: Hamiltonian) -> None:
        """InputError where H has no such coordinate."""
        names = hamiltonian.coordinates
        for given in self.axes:
            if given not in names:
                raise InputError("axes", given, f"is no coordinate; allowed: {', '.join(names)}")
