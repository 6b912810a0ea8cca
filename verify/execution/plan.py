"""A plan: tasks, each once with its reasons, and what is left out and why."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from verify.execution.task import Task

_STEP_SECONDS = 4e-9


def keys_supplied_by(tasks: Iterable[Task]) -> set[str]:
    """Return the keys of the tasks whose results come with these."""
    return {each.key for task in tasks for each in task.gives}


@dataclass
class Plan:
    """Tasks in the order of their requests, each with every reason for it."""

    tasks: dict[str, Task] = field(default_factory=dict)
    reasons: dict[str, list[str]] = field(default_factory=dict)
    left_out: list[tuple[str, str]] = field(default_factory=list)

    def need(self, task: Task, reason: str) -> None:
        """Add the task, once, and the reason for it."""
        name = task.key
        self.tasks.setdefault(name, task)
        reasons = self.reasons.setdefault(name, [])
        if reason not in reasons:
            reasons.append(reason)

    def leave_out(self, what: str, why: str) -> None:
        """Note what is not computed, and why."""
        if (what, why) not in self.left_out:
            self.left_out.append((what, why))

    @property
    def seconds(self) -> float:
        """The approximate processor time of the tasks: by their costs, within a factor of four
        or so, on a machine on which a float64 step takes 4 ns."""
        supplied = keys_supplied_by(self.tasks.values())
        # Tasks whose results come with others' are not counted twice.
        remaining = (task for name, task in self.tasks.items() if name not in supplied)
        costs = (task.cost for task in remaining if task.result_by_proof() is None)
        return _STEP_SECONDS * sum(costs)

    def as_json(self) -> dict[str, Any]:
        return {
            "seconds": f"{self.seconds:.2g}",
            "tasks": [
                {**task.model_dump(mode="json"), "reasons": self.reasons[name]}
                for name, task in self.tasks.items()
            ],
            "left_out": [{"what": what, "why": why} for what, why in self.left_out],
        }
