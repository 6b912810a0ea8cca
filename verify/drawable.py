"""Which classes can be drawn by hypothesis, and by which function of `verify.strategies`.

A class says so where it is made. Whoever draws them listens, and hears of those that are made later
too: hypothesis costs nothing where it is not used.
"""

from collections.abc import Callable
from typing import TypeVar

C = TypeVar("C", bound=type)
Listener = Callable[[type, str], None]  # called with a class and the name of its strategy

_CLASSES: list[tuple[type, str]] = []
_LISTENERS: list[Listener] = []


def drawn_by(name: str) -> Callable[[C], C]:
    """A decorator: the class is drawn by `verify.strategies.name()`."""

    def record(cls: C) -> C:
        _CLASSES.append((cls, name))
        for listener in _LISTENERS:
            listener(cls, name)
        return cls

    return record


def listen(listener: Listener) -> None:
    """The listener is called with each class there is, and with those to come."""
    for cls, name in _CLASSES:
        listener(cls, name)
    if listener not in _LISTENERS:
        _LISTENERS.append(listener)
