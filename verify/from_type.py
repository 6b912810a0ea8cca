"""Registration of our classes with hypothesis, for `st.from_type(Hamiltonian)`.

It works in either order of imports: if hypothesis is imported later, it calls `register` at the end
of its own import, by the entry point in pyproject.toml. Only the standard library is imported here,
and the strategies when something is drawn, so that an installed areaproof does not slow down tests
that do not use it.
"""

import sys
from typing import Any

from verify.drawable import listen


def register() -> None:
    """Register all drawable classes, and those recorded later; a second call changes nothing."""
    listen(_register_strategy)


def _register_strategy(cls: type, name: str) -> None:
    strategies = sys.modules.get("hypothesis.strategies")
    register_type = getattr(strategies, "register_type_strategy", None)
    if register_type is not None:
        register_type(cls, lambda _: _strategy(name))


def _strategy(name: str) -> Any:
    from verify import strategies

    return getattr(strategies, name)()
