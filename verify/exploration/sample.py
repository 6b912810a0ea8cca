"""A drawn scene of the plane as properties look at it: an H, scheme, step size, start, t₀ and N."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from verify.errors import InputError
from verify.exploration.any_sample import AnySample
from verify.hamiltonians.vector_field import VectorField
from verify.proof.order import prove
from verify.proof.order_proof import Proof
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.schemes.every_hamiltonian import TaylorSeries
from verify.schemes.step_map import StepMap

# Terms of a map in all its parts, so that a kernel is written, a proof made, a point looked at.
_MOST_OF_KERNELS, _MOST_TERMS, _MOST_OF_POINTS = 20, 40, 150


@dataclass(frozen=True)
class Sample(AnySample):
    """What a property is asked about; the map and its proof are made once for all of them."""

    p: Fraction
    q: Fraction

    @classmethod
    def of(cls, scene: Scene) -> "Sample":
        """The first scheme, step size and initial value of a scene of the plane that has a [grid].

        Raises InputError for one that has none.
        """
        if scene.grid is None:
            raise InputError("scene", scene.name, "has no [grid], which gives step and start")
        start, h = scene.grid.in_the_plane[0], scene.grid.step_sizes[0]
        return cls(
            hamiltonian=scene.exact_hamiltonian(),
            scheme=get(scene.schemes[0]),
            p=start.p,
            q=start.q,
            step_size=h,
            steps=scene.grid.steps_for(h),
            t0=scene.t0,
            scene=scene,
        )

    @property
    def point(self) -> dict[str, Fraction]:
        """p and q at the start."""
        return {"p": self.p, "q": self.q}

    @property
    def field(self) -> VectorField:
        """H's own, with its derivatives by p and q."""
        return self.hamiltonian.field()[0]

    @cached_property
    def step_map(self) -> StepMap:
        """The map of one step, for this H."""
        return self.scheme.step_map(self.hamiltonian)

    @cached_property
    def proof(self) -> Proof:
        """What is proved of the map: orders, the leading coefficient of ΔJ."""
        return prove(self.step_map, self.scheme)

    @cached_property
    def ordinary(self) -> bool:
        """Whether its map is short enough to be proved in a moment.

        What needs a proof speaks of these alone, so that among thousands of drawn
        scenes not one takes minutes: lie6 of a trigonometric H has a thousand terms, and a
        composition's series for a rational H as many denominators.
        """
        scheme = self.scheme
        if self._terms > _MOST_TERMS:
            return False
        if self.polynomial or scheme.order <= 2 or isinstance(scheme.every_h, TaylorSeries):
            return True
        return scheme.needs_separable and not self._kinds & {"inverse", "root"}

    @property
    def short(self) -> bool:
        """Whether kernels of it are written in a moment."""
        return self.ordinary and self._terms <= _MOST_OF_KERNELS

    @property
    def brief(self) -> bool:
        """Whether its map is short enough to be looked at in a few points in a moment."""
        return self._terms <= _MOST_OF_POINTS

    @cached_property
    def _terms(self) -> int:
        return sum(step.length for step in self.step_map.substeps)

    @property
    def polynomial(self) -> bool:
        """Whether H is a polynomial."""
        return self._kinds <= {"variable"}

    @cached_property
    def _kinds(self) -> set[str]:
        """Of what H's derivatives are made."""
        field = self.step_map.substeps[0].field
        return {g.kind for g in field.ring.generators_in(field.h_p, field.h_q)}

    @property
    def turn(self) -> int:
        """A number by which properties choose what they look at of a sample."""
        return 7 * self.steps + abs(self.p.numerator) + self.q.denominator

    @property
    def run_arguments(self) -> dict[str, Any]:
        """What `run` and `separate` are called with beside H and the scheme."""
        own = {"q": self.q, "p": self.p, "step_size": self.step_size, "steps": self.steps}
        return own | {"t0": self.t0}
