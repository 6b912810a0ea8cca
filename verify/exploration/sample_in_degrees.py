"""A drawn scene in n degrees of freedom as properties look at it."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import inf
from typing import Any

from verify.errors import InputError
from verify.exploration.any_sample import AnySample
from verify.exploration.sample import Sample
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.proof.symplectic.order import prove_symplectic
from verify.proof.symplectic.proof import SymplecticProof
from verify.scenes.scene import Scene
from verify.scenes.values import InitialState
from verify.schemes import get
from verify.schemes.degrees import map_in_degrees
from verify.schemes.degrees.canonical_map import CanonicalMap
from verify.schemes.every_hamiltonian import TaylorSeries

# Terms of what a step is made of, so that a proof is made of it, a kernel written, a point looked
# at, in a moment.
_MOST_TERMS, _MOST_OF_KERNELS, _MOST_OF_POINTS = 30, 60, 250
_MOST_ORDER = 4  # of a scheme whose series is made


@dataclass(frozen=True)
class SampleInDegrees(AnySample):
    """What a property is asked about; the map and its proof are made once for all of them."""

    p: tuple[Fraction, ...]
    q: tuple[Fraction, ...]

    @classmethod
    def of(cls, scene: Scene) -> "SampleInDegrees":
        """The first scheme, step size and initial value of a scene in n degrees of freedom.

        Raises InputError for one that has no [grid].
        """
        if scene.grid is None:
            raise InputError("scene", scene.name, "has no [grid], which gives step and start")
        start, h = scene.grid.initial_values[0], scene.grid.step_sizes[0]
        if not isinstance(start, InitialState):
            raise InputError("scene", scene.name, "starts in the plane; allowed: q and p as lists")
        return cls(
            hamiltonian=scene.exact_hamiltonian(),
            scheme=get(scene.schemes[0]),
            step_size=h,
            steps=scene.grid.steps_for(h),
            t0=scene.t0,
            scene=scene,
            p=start.p,
            q=start.q,
        )

    @property
    def point(self) -> dict[str, Fraction]:
        """p1 … pn, q1 … qn at the start."""
        return dict(zip(self.hamiltonian.coordinates, (*self.p, *self.q), strict=True))

    @property
    def turn(self) -> int:
        """A number by which properties choose what they look at of a sample."""
        return 7 * self.steps + abs(self.p[0].numerator) + self.q[0].denominator

    @property
    def run_arguments(self) -> dict[str, Any]:
        """What `run` is called with beside H and the scheme."""
        own = {"q": self.q, "p": self.p, "step_size": self.step_size, "steps": self.steps}
        return own | {"t0": self.t0}

    @property
    def field(self) -> CanonicalField:
        """H's own."""
        return canonical_field(self.hamiltonian)[0]

    @cached_property
    def step_map(self) -> CanonicalMap:
        """The map of one step, for this H; asked for where it is `brief`."""
        return map_in_degrees(self.scheme, self.hamiltonian)

    @cached_property
    def proof(self) -> SymplecticProof:
        """What is proved of the map: orders, the leading coefficient of S."""
        return prove_symplectic(self.hamiltonian, self.scheme)

    @property
    def ordinary(self) -> bool:
        """Whether its map is proved in a moment: its series in h are short."""
        exact = self.step_map.symplectic_by_conditions if self.brief else False
        small = self._terms <= _MOST_TERMS and (exact or self._kinds <= {"variable", "sin", "cos"})
        return small and self.scheme.order <= _MOST_ORDER

    @property
    def short(self) -> bool:
        """Whether kernels of it are written in a moment."""
        return self._terms <= _MOST_OF_KERNELS

    @property
    def brief(self) -> bool:
        """Whether its map is short enough to be looked at in a few points in a moment."""
        return self._terms <= _MOST_OF_POINTS

    @property
    def polynomial(self) -> bool:
        """Whether H is a polynomial."""
        return self._kinds <= {"variable"}

    @cached_property
    def _kinds(self) -> set[str]:
        """Of what the slopes are made."""
        field = self.field
        return {g.kind for g in field.ring.generators_in(*field.slopes)}

    @cached_property
    def _terms(self) -> float:
        """Of the slopes; of a Taylor series those of all its terms, made one after the other and
        as long as they are few."""
        field, generic = self.field, self.scheme.every_h
        total: float = sum(map(len, field.slopes))
        if not isinstance(generic, TaylorSeries):
            return total
        for n in range(2, generic.eta + 1):
            if total > _MOST_OF_POINTS:
                return inf
            total += sum(map(len, field.power(n)))
        return total


def sample_of(scene: Scene) -> Sample | SampleInDegrees:
    """The scene's sample, of the plane or in n degrees of freedom. InputError: see there."""
    planar = scene.exact_hamiltonian().planar
    return Sample.of(scene) if planar else SampleInDegrees.of(scene)
