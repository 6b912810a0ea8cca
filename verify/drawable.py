"""Classes that hypothesis can draw, each with its function in `verify.strategies`.

A decorator records a class. A listener is called with each class, also with those that are defined
later. So hypothesis need not be imported here, and costs nothing if it is not used.
"""

from collections.abc import Callable
from typing import TypeVar

C = TypeVar("C", bound=type)
Listener = Callable[[type, str], None]  # called with a class and the name of its strategy

_CLASSES: list[tuple[type, str]] = []
_LISTENERS: list[Listener] = []


def drawn_by(name: str) -> Callable[[C], C]:
    """Return a decorator that records a class as drawn by `verify.strategies.name()`."""

    def record(cls: C) -> C:
        _CLASSES.append((cls, name))
        for listener in _LISTENERS:
            listener(cls, name)
        return cls

    return record


def listen(listener: Listener) -> None:
    """Call the listener with each recorded class now, and with each class recorded later."""
    for cls, name in _CLASSES:
        listener(cls, name)
    if listener not in _LISTENERS:
        _LISTENERS.append(listener)
