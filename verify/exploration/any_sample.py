"""What a drawn scene is to properties, in the plane and in n degrees of freedom alike."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify import arithmetic as number_systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, Outcome
from verify.scenes.scene import Scene
from verify.schemes.scheme import Scheme


@dataclass(frozen=True)
class AnySample(ABC):
    """One H, scheme, step size, t₀ and number of steps, of a scene; where it starts, the two kinds
    of samples say."""

    hamiltonian: Hamiltonian
    scheme: Scheme
    step_size: Fraction
    steps: int
    t0: Fraction
    scene: Scene

    @property
    @abstractmethod
    def point(self) -> dict[str, Fraction]:
        """The coordinates at the start, by name."""

    @property
    @abstractmethod
    def turn(self) -> int:
        """A number by which properties choose what they look at of a sample."""

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
    @abstractmethod
    def run_arguments(self) -> dict[str, Any]:
        """What `run` and `separate` are called with beside H and the scheme."""

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
