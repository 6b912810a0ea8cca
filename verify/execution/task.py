"""A task: all that a result depends on, its cost, and how it is computed.

A kind of task is one class, in a file of the study it belongs to.
"""

import hashlib
import json
from abc import abstractmethod
from typing import Any, ClassVar

from verify.execution.keeper import Keeper
from verify.hamiltonians.equations import read_system
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lockstep import Course
from verify.scenes.frozen import Frozen
from verify.scenes.values import Coordinates, ExactNumber


class Task(Frozen):
    """A computation to be done; two tasks of equal content are one.

    `alone`: True if it measures run times, so that nothing else may run beside it; the part that
    may is in `prepare`. `result`: the model of the result of `compute`. `imports`: the modules that
    `compute` or `prepare` imports, which workers import before their first call. `price`: the cost
    of every task of a kind, if they cost about the same.
    """

    alone: ClassVar[bool] = False
    imports: ClassVar[tuple[str, ...]] = ()
    price: ClassVar[int] = 1
    result: ClassVar[type[Frozen]]
    kind: str

    @property
    def cost(self) -> int:
        """The approximate cost of the task in float64 steps."""
        return self.price

    @property
    def ensemble(self) -> str | None:
        """A name shared by the tasks whose runs are stepped together with its own."""
        return None

    @property
    def turn(self) -> float:
        """The sorting key within its ensemble: the costliest task is first."""
        return -self.cost

    def prepare(self) -> object:
        """Compute the part of a task that may run beside others although the task is `alone`.

        A worker does this. `compute` reads the part from the keeper, and computes it itself if the
        keeper has None.
        """
        return None

    @abstractmethod
    def compute(self, keeper: Keeper) -> Frozen:
        """Do the task; a run goes on from the checkpoint that the keeper may have."""

    @property
    def gives(self) -> "tuple[Task, ...]":
        """The tasks whose results come with its own, unless its computation ends early; they need
        not be computed beside it."""
        return ()

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        """Return the result of `compute`, and those of `gives` that have come with it, by keys.

        A task of an ensemble pauses here when its runs wait for others (`verify.lockstep`).
        """
        # A generator without a pause, for tasks that never wait for others.
        yield from ()
        return {self.key: self.compute(keeper)}

    def result_by_proof(self) -> Frozen | None:
        """Return the result if a proof gives it at once, without a computation; None otherwise."""
        return None

    @property
    def key(self) -> str:
        """A name for the task by its content."""
        # The key must not depend on the process, as Python's hash of a text does.
        content = json.dumps(self.model_dump(mode="json"), sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()[:24]

    @property
    def description(self) -> str:
        """A few words on the task, for an error message."""
        content = self.model_dump(mode="json", exclude={"kind"})
        words = [f"{k}={v}" for k, v in content.items() if isinstance(v, str | int)]
        return f"{self.kind} of {', '.join(words)}"


class HamiltonianTask(Task):
    """A task on H, which is given by its formula, or on equations, with parameter values."""

    hamiltonian: str
    parameters: dict[str, ExactNumber]

    def exact_hamiltonian(self) -> Hamiltonian:
        return read_system(self.hamiltonian, self.parameters)

    def other_fields(self, *without: str) -> dict[str, Any]:
        """Return its fields other than those of H, by their names."""
        excluded = {*HamiltonianTask.model_fields, *without}
        return {name: value for name, value in self if name not in excluded}


class SchemeTask(HamiltonianTask):
    """A task on one scheme for one H."""

    scheme: str


class StartTask(SchemeTask):
    """A task on one scheme from one initial value, in any number of degrees of freedom."""

    q: Coordinates
    p: Coordinates
