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
    """Ball arithmetic with so many bits, by one thread at a time; leaves flint's as it was."""
    with _ONE_THREAD, flint.ctx.workprec(bits):
        yield


@contextmanager
def length_of_series(terms: int) -> Iterator[None]:
    """Power series of so many terms; leaves flint's length of them as it was."""
    before, flint.ctx.cap = flint.ctx.cap, terms
    try:
        yield
    finally:
        flint.ctx.cap = before


class AtEachPrecision(Generic[T]):
    """What `make` gives at flint's precision, made once for each."""

    __slots__ = ("_made", "_make")

    def __init__(self, make: Callable[[], T]) -> None:
        self._make = make
        self._made: dict[int, T] = {}

    def __call__(self) -> T:
        bits = flint.ctx.prec
        if bits not in self._made:
            self._made[bits] = self._make()
        return self._made[bits]


def sign_of(value: Callable[[], flint.arb]) -> int:
    """The sign, 1 or −1, of a real number that is known not to be 0.

    `value` gives an enclosure in flint's precision, which is raised until it excludes 0.
    """
    bits = 128
    while True:
        with working_precision(bits):
            enclosure = value()
        if not enclosure.contains(0):
            return 1 if enclosure > 0 else -1
        bits *= 2
