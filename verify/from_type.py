"""Registration of our classes with hypothesis, for `st.from_type(Hamiltonian)`.

It works in either order of imports: hypothesis calls `register` at the end of its own import (its
entry point is in pyproject.toml).
Nothing but the standard library is imported here, and the strategies only when something is drawn:
hypothesis costs no more where areaproof is installed and not used.
"""

import sys
from typing import Any

from verify.drawable import listen


def register() -> None:
    """Register all drawable classes, of now and later; a second call changes nothing."""
    listen(_register_strategy)


def _register_strategy(cls: type, name: str) -> None:
    strategies = sys.modules.get("hypothesis.strategies")
    register_type = getattr(strategies, "register_type_strategy", None)
    if register_type is not None:
        register_type(cls, lambda _: _strategy(name))


def _strategy(name: str) -> Any:
    from verify import strategies

    return getattr(strategies, name)()
