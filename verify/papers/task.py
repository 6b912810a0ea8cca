"""The task that computes the checks of a theorem's argument."""

from typing import Literal

from verify.execution.keeper import Keeper
from verify.execution.task import Task
from verify.papers.argument import Argument


class TheoremTask(Task):
    """The argument for the theorem of that `name`."""

    result = Argument
    imports = ("verify.papers",)
    price = 20_000_000
    kind: Literal["theorem"] = "theorem"
    name: str

    def compute(self, keeper: Keeper) -> Argument:
        """Compute the argument, with its verdict."""
        # Imported here, so that planning the task does not load the papers' libraries.
        from verify.papers import check_theorem

        return check_theorem(self.name)
