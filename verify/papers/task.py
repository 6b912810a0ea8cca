"""The task of a theorem's argument: what it rests on is computed."""

from typing import Literal

from verify.execution.keeping import Keeper
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
        """About how many float64 steps it is worth."""
        return _COST

    def compute(self, keeper: Keeper) -> Argument:
        """The argument, with a verdict."""
        from verify.papers import check_theorem

        return check_theorem(self.name)
