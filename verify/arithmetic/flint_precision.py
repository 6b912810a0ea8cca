"""flint's precision and its length of power series, set for a while and then restored: both are
global to the process."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import RLock
from typing import Generic, TypeVar

import flint

T = TypeVar("T")
_ONE_THREAD = RLock()


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Set the precision of ball arithmetic in bits for a while; one thread at a time may do so."""
    # The precision is global: another thread that set its own meanwhile would change ours.
    with _ONE_THREAD, flint.ctx.workprec(bits):
        yield


@contextmanager
def length_of_series(terms: int) -> Iterator[None]:
    """Set the number of terms of flint's power series for a while."""
    previous_cap, flint.ctx.cap = flint.ctx.cap, terms
    try:
        yield
    finally:
        flint.ctx.cap = previous_cap


class AtEachPrecision(Generic[T]):
    """A value that `make` computes at flint's present precision, once for each precision."""

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
    """Return the sign, 1 or −1, of a real number that must not be 0.

    `value` returns an enclosure of it at flint's precision. The precision is doubled until the
    enclosure excludes 0: for the number 0 this would not end.
    """
    bits = 128
    while True:
        with working_precision(bits):
            enclosure = value()
        if not enclosure.contains(0):
            return 1 if enclosure > 0 else -1
        bits *= 2
