"""A task: all that a result depends on, what it is worth, and how it is computed.

A kind of task is one class, in a file of the study whose it is.
"""

import hashlib
import json
from abc import abstractmethod
from typing import Any, ClassVar

from verify.execution.keeping import Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lockstep import Course
from verify.scenes.frozen import Frozen
from verify.scenes.values import Coordinates, Number


class Task(Frozen):
    """What is to be computed; two tasks of equal content are one.

    `alone`: it measures run times, so that nothing else may run beside it; `prepare` has what may.
    `result`: the model of what `compute` returns. `imports`: the modules that `compute` imports, or
    `prepare`, which workers then have from the start.
    """

    alone: ClassVar[bool] = False
    imports: ClassVar[tuple[str, ...]] = ()
    result: ClassVar[type[Frozen]]
    kind: str

    @property
    def cost(self) -> int:
        """About how many float64 steps the task is worth."""
        return 1

    @property
    def ensemble(self) -> str | None:
        """A name that it has in common with those whose runs its own are stepped together with."""
        return None

    @property
    def turn(self) -> float:
        """When it has its turn among those of its ensemble: what costs most is first."""
        return -self.cost

    def prepare(self) -> object:
        """What of a task that is `alone` may be found beside others, by a worker: `compute` takes
        it from the keeper, and finds it itself where that has None."""
        return None

    @abstractmethod
    def compute(self, keeper: Keeper) -> Frozen:
        """Do it; a run goes on from the checkpoint that the keeper may have."""

    @property
    def gives(self) -> "tuple[Task, ...]":
        """Tasks whose results come with its own, if what it computes has got so far: they need not
        be computed beside it."""
        return ()

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        """What `compute` makes of it, and of those of `gives` that have come with it, by keys.

        One of an ensemble waits here for what its runs ask for (`verify.lockstep`).
        """
        yield from ()
        return {self.key: self.compute(keeper)}

    def proved(self) -> Frozen | None:
        """Its result where a proof gives it at once, and nothing is to be computed."""
        return None

    @property
    def key(self) -> str:
        """A name for the task by its content."""
        content = json.dumps(self.model_dump(mode="json"), sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()[:24]

    @property
    def description(self) -> str:
        """The task in some words, for an error."""
        content = self.model_dump(mode="json", exclude={"kind"})
        words = [f"{k}={v}" for k, v in content.items() if isinstance(v, str | int)]
        return f"{self.kind} of {', '.join(words)}"


class HamiltonianTask(Task):
    """A task on H, which is given by its formula, with its parameter values."""

    hamiltonian: str
    parameters: dict[str, Number]

    def exact_hamiltonian(self) -> Hamiltonian:
        return Hamiltonian.parse(self.hamiltonian, self.parameters)

    def asked(self, *without: str) -> dict[str, Any]:
        """What it asks for beside H, by the names of its fields."""
        beside = {*HamiltonianTask.model_fields, *without}
        return {name: value for name, value in self if name not in beside}


class SchemeTask(HamiltonianTask):
    """A task on one scheme for one H."""

    scheme: str


class StartTask(SchemeTask):
    """A task on one scheme from one initial value, in any number of degrees of freedom."""

    q: Coordinates
    p: Coordinates
