"""flint's precision and its length of series, which are one for the whole process, set for a while
and given back."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import RLock
from typing import Generic, TypeVar

import flint

T = TypeVar("T")
_ONE_THREAD = RLock()


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Set ball arithmetic with so many bits, by one thread at a time; leave flint's as it was."""
    # The precision is one for the process: another thread that set its own meanwhile would change
    # ours.
    with _ONE_THREAD, flint.ctx.workprec(bits):
        yield


@contextmanager
def length_of_series(terms: int) -> Iterator[None]:
    """Set power series of so many terms; leave flint's length of them as it was."""
    before, flint.ctx.cap = flint.ctx.cap, terms
    try:
        yield
    finally:
        flint.ctx.cap = before


class AtEachPrecision(Generic[T]):
    """A value computed by `make` at flint's precision, once for each precision."""

    __slots__ = ("_make", "_values")

    def __init__(self, make: Callable[[], T]) -> None:
        self._make = make
        self._values: dict[int, T] = {}

    def __call__(self) -> T:
        bits = flint.ctx.prec
        if bits not in self._values:
            self._values[bits] = self._make()
        return self._values[bits]


def sign_of(value: Callable[[], flint.arb]) -> int:
    """Return the sign, 1 or −1, of a real number that is known not to be 0.

    `value` gives an enclosure in flint's precision, which is raised until it excludes 0.
    """
    bits = 128
    while True:
        with working_precision(bits):
            enclosure = value()
        if not enclosure.contains(0):
            return 1 if enclosure > 0 else -1
        bits *= 2
