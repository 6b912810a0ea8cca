"""Work that does not end is given up after so many calls, in every thread, and leaves no trace."""

import sys
import threading
from collections.abc import Callable, Iterator

import pytest

from verify.effort import Effort, answer_unless_long, limit_effort
from verify.errors import LimitError


def forever() -> int:
    while True:
        abs(one())


def one() -> int:
    return 1


def many(count: int) -> int:
    return sum(one() for _ in range(count))


def test_what_does_not_end_is_an_error_that_names_the_input() -> None:
    with pytest.raises(LimitError, match="map=p: to compose it takes too long"), \
         limit_effort("map", "p", "to compose it"):  # fmt: skip
        forever()
    assert sys.getprofile() is None


def test_what_need_not_be_known_is_answered_otherwise() -> None:
    assert answer_unless_long(lambda: many(10), 0) == 10
    assert answer_unless_long(forever, 7, most=1000) == 7
    with pytest.raises(LimitError, match="its own"):
        answer_unless_long(lambda: (_ for _ in ()).throw(LimitError("x", 1, "its own")), None)


def test_a_count_goes_on_where_it_is_entered_again() -> None:
    effort = Effort(1000, LimitError("x", 1, "spent"))
    with effort:
        many(100)
    with pytest.raises(LimitError, match="spent"), effort:
        many(900)


@pytest.mark.parametrize(
    ("inner", "outer", "said"), [(10**6, 1000, "outer"), (1000, 10**6, "inner")]
)
def test_of_two_that_of_fewer_calls_ends_it(inner: int, outer: int, said: str) -> None:
    with pytest.raises(LimitError, match=said), Effort(outer, LimitError("x", 1, "outer")):  # noqa: SIM117
        with Effort(inner, LimitError("x", 1, "inner")):
            forever()
    assert sys.getprofile() is None


def test_an_inner_one_that_is_spent_leaves_the_outer_counting() -> None:
    def inner_and_more() -> int:
        assert answer_unless_long(forever, 3, most=1000) == 3
        return forever()

    assert answer_unless_long(inner_and_more, 4, most=10_000) == 4


@pytest.mark.parametrize("most", range(40))
def test_wherever_it_is_spent_nothing_is_left_behind(most: int) -> None:
    """At its last calls, too, which are those of its own end."""
    effort = Effort(most, LimitError("x", 1, "spent"))
    try:
        with effort:
            many(5)
    except LimitError:
        assert effort.calls_left < 0
    assert sys.getprofile() is None


def test_a_handler_on_the_way_does_not_swallow_it() -> None:
    def swallows() -> None:
        while True:
            try:
                one()
            except Exception:  # noqa: S112 - as libraries do
                continue

    assert answer_unless_long(swallows, "given up", most=1000) == "given up"  # type: ignore[arg-type]


def test_a_generator_that_is_closed_does_not_lose_it() -> None:
    """Python prints what a generator raises as it is closed, and goes on without counting."""

    def closed_early() -> int:
        while True:
            any(each() > 0 for each in _functions())

    assert answer_unless_long(closed_early, -1, most=5000) == -1


def _functions() -> Iterator[Callable[[], int]]:
    while True:
        yield one


@pytest.mark.parametrize(
    "endless",
    [
        lambda: sum(x.bit_length() for x in iter(int, 1)),
        lambda: all(one() for _ in iter(int, 1)),
    ],
)
def test_loops_within_generators_and_in_c_are_ended(endless: Callable[[], int]) -> None:
    assert answer_unless_long(endless, -1, most=5000) == -1


def test_a_profiler_goes_on_undisturbed() -> None:
    seen: list[str] = []

    def profiler(_: object, event: str, __: object) -> None:
        seen.append(event)

    sys.setprofile(profiler)
    try:
        with Effort(3, LimitError("x", 1, "spent")):
            many(10)
        assert sys.getprofile() is profiler
    finally:
        sys.setprofile(None)
    assert len(seen) > 10


def test_other_threads_have_the_limit_and_not_this_one() -> None:
    found: list[int] = []
    thread = threading.Thread(
        target=lambda: found.append(answer_unless_long(forever, 9, most=50_000))
    )
    thread.start()
    assert many(100_000) == 100_000
    thread.join(60)
    assert found == [9]
