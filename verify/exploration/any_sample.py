"""What a drawn scene is to properties, in the plane and in n degrees of freedom alike."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar, Self

from verify import arithmetic as number_systems
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.flows.extrapolation import Flow
from verify.hamiltonians.canonical_field import CanonicalField, canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, Outcome
from verify.proof.order import prove
from verify.proof.proof import Proof
from verify.scenes.run_sections import Grid
from verify.scenes.scene import Scene
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme


@dataclass(frozen=True)
class AnySample(ABC):
    """One H, scheme, step size, t₀ and number of steps, of a scene; where it starts, the two kinds
    of samples say."""

    most_of_kernels: ClassVar[int]
    """Terms, so that a kernel is written in a moment."""
    most_of_points: ClassVar[int]
    """Terms, so that a point is looked at in a moment."""
    hamiltonian: Hamiltonian
    scheme: Scheme
    step_size: Fraction
    steps: int
    t0: Fraction
    scene: Scene
    p: Any
    q: Any

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """The first scheme, step size and initial value of a scene that has a [grid].

        Raises InputError for one that has none, or that starts elsewhere.
        """
        if scene.grid is None:
            raise InputError("scene", scene.name, "has no [grid], which gives step and start")
        h = scene.grid.step_sizes[0]
        return cls(
            hamiltonian=scene.exact_hamiltonian(),
            scheme=get(scene.schemes[0]),
            step_size=h,
            steps=scene.grid.steps_for(h),
            t0=scene.t0,
            scene=scene,
            **cls._initial(scene, scene.grid),
        )

    @classmethod
    @abstractmethod
    def _initial(cls, scene: Scene, grid: Grid) -> dict[str, Any]:
        """p and q of the first initial value."""

    @abstractmethod
    def at(self, values: Sequence[Fraction]) -> Self:
        """The same from another point, whose coordinates are given in their order."""

    @property
    @abstractmethod
    def point(self) -> dict[str, Fraction]:
        """The coordinates at the start, by name."""

    @cached_property
    def step_map(self) -> StepMap:
        """The map of one step, for this H; asked for where it is `brief`."""
        return self.scheme.step_map(self.hamiltonian)

    @cached_property
    def proof(self) -> Proof:
        """What is proved of the map: orders, the leading coefficient of its defect."""
        return prove(self.step_map, self.scheme)

    @property
    @abstractmethod
    def ordinary(self) -> bool:
        """Whether its map is proved in a moment."""

    @property
    @abstractmethod
    def terms(self) -> float:
        """How many there are of what a step is made of."""

    @property
    def short(self) -> bool:
        """Whether kernels of it are written in a moment."""
        return self.terms <= self.most_of_kernels

    @property
    def brief(self) -> bool:
        """Whether its map is short enough to be looked at in a few points in a moment."""
        return self.terms <= self.most_of_points

    @property
    def field(self) -> CanonicalField:
        """H's own, with its derivatives by the coordinates."""
        return canonical_field(self.hamiltonian)[0]

    def flow(self, digits: int) -> Flow:
        """The exact flow, to so many digits."""
        return Flow(self.field, digits)

    @property
    def slopes(self) -> tuple[Ring, Sequence[Poly]]:
        """The derivatives of the coordinates by t, in their order, and their ring."""
        return self.field.ring, self.field.slopes

    @property
    def polynomial(self) -> bool:
        """Whether H is a polynomial."""
        return self._kinds <= {"variable"}

    @cached_property
    def _kinds(self) -> set[str]:
        """Of what the slopes are made."""
        ring, slopes = self.slopes
        return {g.kind for g in ring.generators_in(*slopes)}

    @property
    def turn(self) -> int:
        """A number by which properties choose what they look at of a sample."""
        names, point = self.hamiltonian.coordinates, self.point
        p, q = point[names[0]], point[names[len(names) // 2]]
        return 7 * self.steps + abs(p.numerator) + q.denominator

    def is_turn(self, one_in: int, after: int = 0) -> bool:
        """Whether a property that takes long looks at this sample: at one in so many.

        `after`: properties with different ones look at different samples.
        """
        return self.turn % one_in == after

    @property
    def kernel_inputs(self) -> tuple[Hamiltonian, str, dict[str, Fraction], int]:
        """What a `KernelRun` and a `Separation` begin with."""
        return self.hamiltonian, self.scheme.name, self.start, self.steps

    def run(
        self,
        number_system: str,
        digits: int,
        *observables: str,
        start: dict[str, Fraction] | None = None,
        steps: int | None = None,
    ) -> Outcome:
        """Its run in a kernel; `start` and `steps` where they are not its own."""
        begin, count = start or self.start, self.steps if steps is None else steps
        asked = frozenset(observables)
        run = KernelRun(self.hamiltonian, self.scheme.name, begin, count, asked, 0)
        return run.run(number_systems.get(number_system, digits))

    @property
    def run_arguments(self) -> dict[str, Any]:
        """What `run` and `separate` are called with beside H and the scheme."""
        own = {"q": self.q, "p": self.p, "step_size": self.step_size, "steps": self.steps}
        return own | {"t0": self.t0}

    @property
    def timed(self) -> bool:
        """Whether H depends on t."""
        return self.hamiltonian.time_dependent

    @property
    def start(self) -> dict[str, Fraction]:
        """The coordinates and h by name, and t where H depends on it, as a run and an enclosure
        want them."""
        own = {**self.point, "h": self.step_size}
        return own | {"t": self.t0} if self.timed else own
