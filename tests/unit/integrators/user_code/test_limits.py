"""A limit in seconds ends what runs within it, even where Python drops the first alarm."""

import gc
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import pytest

from verify.integrators.user_code.step import StepError, limit_time


def busy(seconds: float) -> None:
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        pass


class Lingering:
    """Its finalizer is still busy when the alarm rings: Python drops what is raised there."""

    def __del__(self) -> None:
        busy(0.2)


@contextmanager
def collected_slowly() -> Iterator[None]:
    def callback(phase: str, _: object) -> None:
        if phase == "start":
            busy(0.2)

    gc.callbacks.append(callback)
    try:
        yield
    finally:
        gc.callbacks.remove(callback)


def in_a_finalizer() -> None:
    Lingering()


def in_a_collection() -> None:
    with collected_slowly():
        gc.collect()


def in_a_bare_except() -> None:
    with suppress(BaseException):
        busy(0.2)


def seconds_until(slow: Callable[[], None], problem: str) -> float:
    """How long it takes until it is ended for this reason."""
    begun = time.perf_counter()
    with pytest.raises(StepError, match=problem):
        slow()
    return time.perf_counter() - begun


@pytest.mark.left_to_ci
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("first", [in_a_finalizer, in_a_collection, in_a_bare_except])
def test_an_alarm_that_is_dropped_rings_again(first: Callable[[], None]) -> None:
    def slow() -> None:
        with limit_time(0.1, "it takes too long"):
            first()
            busy(10)

    assert seconds_until(slow, "it takes too long") < 5


@pytest.mark.left_to_ci
def test_an_outer_limit_goes_on_after_an_inner_one() -> None:
    def inner() -> None:
        with limit_time(0.05, "inner"):
            in_a_finalizer()
            busy(10)

    def outer() -> None:
        with limit_time(0.3, "outer"):
            for _ in range(100):
                seconds_until(inner, "inner")

    assert seconds_until(outer, "outer") < 5


@pytest.mark.parametrize("seconds", [1e-9, 1e-6, 6e-6, 1e-5, 1e-4])
def test_however_little_time_is_left_an_alarm_is_a_step_error(seconds: float) -> None:
    """As where a call begins that has some microseconds left of all the time that there is."""
    for _ in range(3):
        with suppress(StepError), limit_time(seconds, "it takes too long"):
            pass
        with pytest.raises(StepError, match="too long"), limit_time(seconds, "it takes too long"):
            busy(10)


def test_no_alarm_rings_after_the_end() -> None:
    def slow() -> None:
        with limit_time(0.05, "it takes too long"):
            busy(10)

    seconds_until(slow, "it takes too long")
    busy(1.2)
