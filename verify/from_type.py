"""Which classes hypothesis can draw: `st.from_type(Hamiltonian)` works in either order of imports.

A class says by which function of `verify.strategies` it is drawn. hypothesis calls `register` at
the end of its own import (its entry point is in pyproject.toml), and a class that is made later
registers itself. Nothing but the standard library is imported here, and the strategies only when
something is drawn: hypothesis costs no more where areaproof is installed and not used.
"""

import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

C = TypeVar("C", bound=type)

_DRAWN: list[tuple[type, str]] = []


def drawn_by(name: str) -> Callable[[C], C]:
    """A decorator: the class is drawn by `verify.strategies.name()`."""

    def record(cls: C) -> C:
        _DRAWN.append((cls, name))
        _tell(cls, name)
        return cls

    return record


def register() -> None:
    """Tell hypothesis of the classes that are known so far; to do so twice changes nothing."""
    for cls, name in _DRAWN:
        _tell(cls, name)


def _tell(cls: type, name: str) -> None:
    """Register the class where hypothesis is loaded far enough for that; else `register` will."""
    strategies = sys.modules.get("hypothesis.strategies")
    tell = getattr(strategies, "register_type_strategy", None)
    if tell is not None:
        tell(cls, lambda _: _strategy(name))


def _strategy(name: str) -> Any:
    return getattr(import_module("verify.strategies"), name)()
