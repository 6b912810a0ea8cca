"""flint's precision, which is one for the whole process, set for a while and given back."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import RLock
from typing import TypeVar

import flint

T = TypeVar("T")
_ONE_THREAD = RLock()


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Ball arithmetic with so many bits, by one thread at a time; leaves flint's as it was."""
    with _ONE_THREAD, flint.ctx.workprec(bits):
        yield


def at_each_precision(make: Callable[[], T]) -> Callable[[], T]:
    """What `make` gives at flint's precision, made once for each."""
    made: dict[int, T] = {}

    def given() -> T:
        bits = flint.ctx.prec
        if bits not in made:
            made[bits] = make()
        return made[bits]

    return given


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
