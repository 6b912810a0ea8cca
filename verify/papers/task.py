"""The task that computes the checks of a theorem's argument."""

from typing import Literal

from verify.execution.keeper import Keeper
from verify.execution.task import Task
from verify.papers.argument import Argument

_COST = 20_000_000  # of an argument, about


class TheoremTask(Task):
    """The argument for the theorem of that `name`."""

    result = Argument
    imports = ("verify.papers",)
    kind: Literal["theorem"] = "theorem"
    name: str

    @property
    def cost(self) -> int:
        """The estimated cost in float64 steps."""
        return _COST

    def compute(self, keeper: Keeper) -> Argument:
        """Compute the argument, with its verdict."""
        # Imported here, so that planning the task does not load the papers' libraries.
        from verify.papers import check_theorem

        return check_theorem(self.name)
