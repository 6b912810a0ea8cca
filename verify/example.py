"""One drawn scene as properties look at it: one H, scheme, step size, initial value and N."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from verify.errors import InputError
from verify.hamiltonian import Hamiltonian
from verify.proof.order import Proof, prove
from verify.scene import Scene
from verify.scheme import Scheme
from verify.schemes import get
from verify.step_map import StepMap


@dataclass(frozen=True)
class Example:
    """What a property is asked about; the map and its proof are made once for all of them."""

    hamiltonian: Hamiltonian
    scheme: Scheme
    p: Fraction
    q: Fraction
    step_size: Fraction
    steps: int
    scene: Scene

    @classmethod
    def of(cls, scene: Scene) -> "Example":
        """The first scheme, step size and initial value of a scene that has a [grid].

        Raises InputError for one that has none.
        """
        if scene.grid is None:
            raise InputError("scene", scene.name, "has no [grid], which gives step and start")
        start, h = scene.grid.initial_values[0], scene.grid.step_sizes[0]
        return cls(
            hamiltonian=scene.exact_hamiltonian(),
            scheme=get(scene.schemes[0]),
            p=start.p,
            q=start.q,
            step_size=h,
            steps=scene.grid.steps_for(h),
            scene=scene,
        )

    @cached_property
    def step_map(self) -> StepMap:
        return self.scheme.step_map(self.hamiltonian)

    @cached_property
    def proof(self) -> Proof:
        return prove(self.step_map, self.scheme)

    @property
    def start(self) -> dict[str, Fraction]:
        """p, q and h by name, as a job and an enclosure want them."""
        return {"p": self.p, "q": self.q, "h": self.step_size}
