"""The task of a region carried by a map."""

from typing import Literal

from pydantic import Field

from verify.execution.keeping import Keeper
from verify.execution.task import HamiltonianTask
from verify.scenes.region_sections import PlacedShape
from verify.scenes.results.regions import FlowImage
from verify.scenes.values import Number, StepSize

_COST, _POINTS = 40_000_000, 40_000  # of a region, and how many points of it are carried


class FlowTask(HamiltonianTask):
    """Carry a shape by `steps` steps of a map: a scheme's, or the exact flow's."""

    result = FlowImage
    imports = ("verify.studies.regions.carry", "verify.studies.regions.place")
    kind: Literal["flow"] = "flow"
    map: str
    shape: PlacedShape
    step_size: StepSize
    t0: Number | None = None
    steps: int
    digits: int
    mean_lambda: bool
    distance: bool
    point: dict[str, Number] = Field(default_factory=dict)
    """The centre's coordinates by their names; `plane`: in which it lies. Left out: p and q."""
    plane: int = 1

    @property
    def cost(self) -> int:
        """About how many float64 steps it is worth."""
        return _COST + _POINTS * self.steps

    @property
    def ensemble(self) -> str | None:
        """A key of the maps of one region: they carry mostly the same points of it.

        They are compared with the same exact ones, too.
        """
        return f"{self.kind} {self.hamiltonian} {self.parameters} {self.shape} {self.t0 or 0}"

    @property
    def turn(self) -> float:
        """The time: maps over longer ones come later, and carry on the points of the others."""
        return float(self.step_size * self.steps)

    def compute(self, keeper: Keeper) -> FlowImage:
        """Return the images of the outline as a result."""
        from verify.studies.regions.carry import carry
        from verify.studies.regions.place import ITSELF, Place

        place = Place.from_point(self.point, self.plane) if self.point else ITSELF
        shape = self.shape.to_shape()
        arguments = self.other_fields("map", "shape", "point", "plane")
        return carry(self.exact_hamiltonian(), self.map, shape, place=place, **arguments)
