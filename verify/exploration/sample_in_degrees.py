"""A drawn scene in n degrees of freedom as properties look at it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import inf
from typing import Any, Self

from verify.errors import InputError
from verify.exploration.any_sample import AnySample
from verify.exploration.sample import Sample
from verify.functions.function import CIRCLE
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.scenes.values import InitialState
from verify.schemes.conditions.every_hamiltonian import TaylorSeries

_MOST_TERMS = 30  # of what a step is made of, so that a proof is made of it in a moment
_MOST_ORDER = 4  # of a scheme whose series is made
_OF_SHORT_SERIES = {"variable", CIRCLE.odd, CIRCLE.even}  # as other functions' are not


@dataclass(frozen=True)
class SampleInDegrees(AnySample):
    """What a property is asked about; the map and its proof are made once for all of them."""

    most_of_kernels = 60
    most_of_points = 250
    p: tuple[Fraction, ...]
    q: tuple[Fraction, ...]

    @classmethod
    def _initial(cls, scene: Scene, grid: Grid) -> dict[str, Any]:
        start = grid.initial_values[0]
        if not isinstance(start, InitialState):
            raise InputError("scene", scene.name, "starts in the plane; allowed: q and p as lists")
        return {"p": start.p, "q": start.q}

    def at(self, values: Sequence[Fraction]) -> Self:
        degrees = len(values) // 2
        return replace(self, p=tuple(values[:degrees]), q=tuple(values[degrees:]))

    @property
    def point(self) -> dict[str, Fraction]:
        """p1 … pn, q1 … qn at the start."""
        return dict(zip(self.hamiltonian.coordinates, (*self.p, *self.q), strict=True))

    @property
    def ordinary(self) -> bool:
        """Whether its map is proved in a moment: its series in h are short."""
        exact = self.step_map.symplectic_by_conditions if self.brief else False
        small = self.terms <= _MOST_TERMS and (exact or self._kinds <= _OF_SHORT_SERIES)
        return small and self.scheme.order <= _MOST_ORDER

    @cached_property
    def terms(self) -> float:
        """Of the slopes; of a Taylor series those of all its terms, made one after the other and
        as long as they are few."""
        field, generic = self.field, self.scheme.every_h
        total: float = sum(map(len, field.slopes))
        if not isinstance(generic, TaylorSeries):
            return total
        for n in range(2, generic.eta + 1):
            if total > self.most_of_points:
                return inf
            total += sum(map(len, field.power(n)))
        return total


def sample_of(scene: Scene) -> Sample | SampleInDegrees:
    """The scene's sample, of the plane or in n degrees of freedom. InputError: see there."""
    planar = scene.exact_hamiltonian().planar
    return Sample.of(scene) if planar else SampleInDegrees.of(scene)
