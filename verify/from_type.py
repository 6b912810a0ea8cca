"""`st.from_type(Hamiltonian)` works in either order of imports.

hypothesis calls `register` at the end of its own import (its entry point is in pyproject.toml).
Nothing but the standard library is imported here, and the strategies only when something is drawn:
hypothesis costs no more where areaproof is installed and not used.
"""

import sys
from typing import Any

from verify.drawable import listen


def register() -> None:
    """Tell hypothesis of the classes there are, and of those to come; twice changes nothing."""
    listen(_tell)


def _tell(cls: type, name: str) -> None:
    strategies = sys.modules.get("hypothesis.strategies")
    tell = getattr(strategies, "register_type_strategy", None)
    if tell is not None:
        tell(cls, lambda _: _strategy(name))


def _strategy(name: str) -> Any:
    from verify import strategies

    return getattr(strategies, name)()
