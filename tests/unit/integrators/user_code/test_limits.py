"""A limit in seconds ends what runs within it, even where Python drops the first alarm."""

import gc
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from verify.integrators.user_code.step import StepError, within


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
    try:
        busy(0.2)
    except BaseException:
        pass


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("first", [in_a_finalizer, in_a_collection, in_a_bare_except])
def test_an_alarm_that_is_dropped_rings_again(first: Callable[[], None]) -> None:
    begun = time.perf_counter()
    with pytest.raises(StepError, match="it takes too long"), within(0.1, "it takes too long"):
        first()
        busy(10)
    assert time.perf_counter() - begun < 5


def test_an_outer_limit_goes_on_after_an_inner_one() -> None:
    begun = time.perf_counter()
    with pytest.raises(StepError, match="outer"), within(0.3, "outer"):
        for _ in range(100):
            with pytest.raises(StepError, match="inner"), within(0.05, "inner"):
                in_a_finalizer()
                busy(10)
    assert time.perf_counter() - begun < 5


def test_no_alarm_rings_after_the_end() -> None:
    with pytest.raises(StepError), within(0.05, "it takes too long"):
        busy(10)
    busy(1.2)
