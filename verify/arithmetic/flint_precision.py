"""flint's precision, which is one for the whole process, set for a while and given back."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import RLock

import flint

_ONE_THREAD = RLock()


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Ball arithmetic with so many bits, by one thread at a time; leaves flint's as it was."""
    with _ONE_THREAD, flint.ctx.workprec(bits):
        yield


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
