"""flint's precision, which is one for the whole process, set for a while and given back."""

from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock

import flint

_ONE_THREAD = RLock()


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Ball arithmetic with so many bits, by one thread at a time; leaves flint's as it was."""
    with _ONE_THREAD, flint.ctx.workprec(bits):
        yield
