"""A drawn scene of the plane as properties look at it: an H, scheme, step size, start, t₀ and N."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, Self

from verify.exploration.any_sample import AnySample
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.schemes.conditions.every_hamiltonian import TaylorSeries

_MOST_TERMS = 40  # of a map in all its parts, so that a proof is made in a moment


@dataclass(frozen=True)
class Sample(AnySample):
    """What a property is asked about; the map and its proof are made once for all of them."""

    most_of_kernels = 20
    most_of_points = 150
    p: Fraction
    q: Fraction

    @classmethod
    def _initial(cls, scene: Scene, grid: Grid) -> dict[str, Any]:
        start = grid.in_the_plane[0]
        return {"p": start.p, "q": start.q}

    def at(self, values: Sequence[Fraction]) -> Self:
        p, q = values
        return replace(self, p=p, q=q)

    @property
    def point(self) -> dict[str, Fraction]:
        """p and q at the start."""
        return {"p": self.p, "q": self.q}

    @cached_property
    def ordinary(self) -> bool:
        """Whether its map is short enough to be proved in a moment.

        What needs a proof speaks of these alone, so that among thousands of drawn
        scenes not one takes minutes: lie6 of a trigonometric H has a thousand terms, and a
        composition's series for a rational H as many denominators.
        """
        scheme = self.scheme
        if self.terms > _MOST_TERMS:
            return False
        if self.polynomial or scheme.order <= 2 or isinstance(scheme.every_h, TaylorSeries):
            return True
        return scheme.needs_separable and not self._kinds & {"inverse", "root"}

    @property
    def short(self) -> bool:
        """Whether kernels of it are written in a moment."""
        return self.ordinary and super().short

    @cached_property
    def terms(self) -> int:
        return self.step_map.terms
