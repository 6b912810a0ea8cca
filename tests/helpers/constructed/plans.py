"""A scene with eight tasks, where their results are kept, and what of these is compared."""

from pathlib import Path
from typing import Any

from tests.helpers.constructed.scenes import DUFFING, GRID, SERIES
from verify.execution.execute import Store
from verify.scenes.frozen import Frozen

CONTENT = (
    DUFFING.replace('"lie2"', '"lie2", "lie3"')
    + 'parameters = { delta = "7/3" }\n'
    + GRID.replace("time = 1", "steps = 50").replace("[0.1]", "[0.1, 0.05]")
    + SERIES
)


def kept_in(folder: Path) -> Store:
    return Store(folder / "kept")


def plain(results: dict[str, Frozen]) -> dict[str, dict[str, Any]]:
    """The results without their run times."""
    return {name: r.model_dump(exclude={"seconds"}) for name, r in results.items()}
