"""A plan: tasks, each once with its reasons, and what is left out and why."""

from dataclasses import dataclass, field
from typing import Any

from verify.execution.task import Task


@dataclass
class Plan:
    """Tasks in the order they are asked for, each with every reason for it."""

    tasks: dict[str, Task] = field(default_factory=dict)
    reasons: dict[str, list[str]] = field(default_factory=dict)
    left_out: list[tuple[str, str]] = field(default_factory=list)

    def need(self, task: Task, reason: str) -> None:
        """Adds the task, once, and the reason for it."""
        name = task.key
        self.tasks.setdefault(name, task)
        reasons = self.reasons.setdefault(name, [])
        if reason not in reasons:
            reasons.append(reason)

    def leave_out(self, what: str, why: str) -> None:
        """Says what is not computed, and why."""
        if (what, why) not in self.left_out:
            self.left_out.append((what, why))

    def as_json(self) -> dict[str, Any]:
        return {
            "tasks": [
                {**task.model_dump(mode="json"), "reasons": self.reasons[name]}
                for name, task in self.tasks.items()
            ],
            "left_out": [{"what": what, "why": why} for what, why in self.left_out],
        }
