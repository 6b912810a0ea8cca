"""The processor time of processes that were started and have ended: a busy machine adds none."""

import resource
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def of_children_below(seconds: float) -> Iterator[None]:
    """AssertionError where the processes that end within take as long, or longer."""
    before = _seconds()
    yield
    taken = _seconds() - before
    assert taken < seconds, f"{taken:.2f} s of processor time, and not below {seconds}"


def _seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
