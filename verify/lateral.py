"""What a result shows of itself and is computed in a room above it: who computes it.

`verify` itself says so when it is imported, so that a result need not know where that is done.
"""

from collections.abc import Callable
from typing import Any

_COMPUTED: dict[str, Callable[..., Any]] = {}


def computed_by(name: str, function: Callable[..., Any]) -> None:
    """From now on `compute(name, …)` calls the function."""
    _COMPUTED[name] = function


def compute(name: str, *given: Any) -> Any:
    """What is computed under that name, of a result."""
    return _COMPUTED[name](*given)
