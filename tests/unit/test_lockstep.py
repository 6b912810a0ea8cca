"""Functions in lockstep give what each gives by itself, and end where nobody waits for them."""

import sys
from collections.abc import Generator, Sequence
from typing import Any

import pytest

from verify import lockstep
from verify.lockstep import Course, Pending, meet, run_alone, run_together


class Doubling:
    """Doubles numbers, all that are asked of it at once; odd ones take two times."""

    def __init__(self) -> None:
        self.sizes: list[int] = []

    def advance(self, pending: Sequence[Pending]) -> None:
        self.sizes.append(len(pending))
        for each in pending:
            if each.request < 0:
                each.end(None, ValueError(f"{each.request} is negative"))
            elif each.request % 2 and each.state is None and len(pending) > 1:
                each.state = "begun"
            else:
                each.seconds += 1000.0
                each.end(2 * each.request)


class Four(Doubling):
    """Takes four at most, and notes how many."""

    def advance(self, pending: Sequence[Pending]) -> None:
        super().advance(pending[:4])


def chain(work: Doubling, start: int, times: int) -> Course[int]:
    for _ in range(times):
        start = (yield from meet(work, start)) + 1
    return start


def results(courses: Sequence[Course[Any]], most: int) -> dict[int, Any]:
    return {number: ended.result() for number, ended in run_together(iter(courses), most)}


def by_itself(value: int) -> Course[int]:
    """Meets nobody."""
    yield from ()
    return value


@pytest.mark.parametrize("most", [1, 2, 3, 50])
def test_each_gives_what_it_gives_by_itself(most: int) -> None:
    work = Doubling()
    found = results([chain(work, k, k % 4) for k in range(20)], most)
    assert found == {k: run_alone(chain(Doubling(), k, k % 4)) for k in range(20)}
    assert max(work.sizes) <= most


def test_what_is_asked_at_once_is_done_together() -> None:
    work = Doubling()
    results([chain(work, 2 * k, 1) for k in range(7)], 50)
    assert work.sizes == [7]


def test_the_work_that_is_waited_for_longest_is_done_first() -> None:
    one, other = Doubling(), Doubling()
    order: list[str] = []
    for name, work in (("one", one), ("other", other)):
        advance = work.advance
        work.advance = lambda p, n=name, f=advance: (order.append(n), f(p))[1]  # type: ignore
    results([chain(one, 2, 1), chain(other, 2, 1), chain(other, 2, 1)], 50)
    assert order == ["one", "other"]


@pytest.mark.parametrize("count", [5, 6, 7, 15])
def test_nobody_is_left_to_go_on_alone(count: int) -> None:
    """Each needs one work, then another; both are done for four at once nearly all the time."""
    first, second = Four(), Four()

    def both() -> Course[None]:
        for work in [first] * 20 + [second] * 20:
            yield from meet(work, 2)

    results([both() for _ in range(count)], 50)
    for work in (first, second):
        assert sum(work.sizes) == 20 * count
        assert len(work.sizes) <= 20 * count / 4 + 3


def test_an_error_is_that_of_its_own_function_alone() -> None:
    work = Doubling()
    ended = dict(run_together(iter([chain(work, k, 1) for k in (2, -1, 4)]), 50))
    assert ended[0].result() == 5
    assert ended[2].result() == 9
    with pytest.raises(ValueError, match="-1 is negative"):
        ended[1].result()


def test_functions_that_meet_nobody_are_all_called() -> None:
    assert results([by_itself(k) for k in range(9)], 2) == {k: k for k in range(9)}
    assert results([], 2) == {}


def test_without_others_it_is_done_at_once() -> None:
    assert run_alone(meet(Doubling(), 21)) == 42
    with pytest.raises(ValueError, match="negative"):
        run_alone(meet(Doubling(), -3))


def test_what_a_work_raises_is_raised_where_it_is_waited_for() -> None:
    """So a run that is interrupted amid its steps keeps what it has."""

    class Stopping(Doubling):
        def advance(self, pending: Sequence[Pending]) -> None:
            raise KeyboardInterrupt

    seen: list[str] = []

    def kept(again: bool) -> Course[int]:
        try:
            yield from meet(Stopping(), 1)
        except KeyboardInterrupt:
            seen.append("kept")
            if not again:
                raise
        return (yield from meet(Doubling(), 3))

    with pytest.raises(KeyboardInterrupt):
        run_alone(kept(again=False))
    assert run_alone(kept(again=True)) == 6
    assert seen == ["kept"] * 2


def test_those_that_wait_are_ended_where_nobody_waits_for_them() -> None:
    seen: list[str] = []

    def waiting(work: Doubling) -> Course[None]:
        try:
            yield from chain(work, 2, 5)
        except BaseException as error:
            seen.append(type(error).__name__)
            raise
        seen.append("ended")

    work = Doubling()
    for first in (by_itself(1), chain(work, 2, 1)):
        seen.clear()
        whole = run_together(iter([first, waiting(work), waiting(work)]), 50)
        assert isinstance(whole, Generator)
        next(whole)
        whole.close()
    assert seen == ["GeneratorExit"] * 2


@pytest.mark.parametrize("at", range(3))
def test_an_interruption_is_everybodys(at: int) -> None:
    """Ctrl-C comes while one of them runs; the others write what they have."""
    seen: list[str] = []

    def kept(work: Doubling, interrupted: bool) -> Course[None]:
        try:
            yield from chain(work, 2, 1)
            if interrupted:
                raise KeyboardInterrupt
            yield from chain(work, 2, 1)
        except KeyboardInterrupt:
            seen.append("kept")
            raise

    work = Doubling()
    with pytest.raises(KeyboardInterrupt):
        results([kept(work, k == at) for k in range(3)], 50)
    assert seen == ["kept"] * 3


class Interrupted:
    """A trace function that raises KeyboardInterrupt at the n-th line of `lockstep` itself."""

    def __init__(self, at: int) -> None:
        self.left = at

    def __call__(self, frame: Any, event: str, _: Any) -> Any:
        if frame.f_code.co_filename != lockstep.__file__:
            return None
        if event == "line" and frame.f_code.co_name in ("run_together", "resume", "_advance"):
            self.left -= 1
            if self.left == 0:
                raise KeyboardInterrupt
        return self


def test_nobody_is_forgotten_whenever_an_interruption_comes() -> None:
    begun: list[int] = []
    ended: list[int] = []

    def counted(work: Doubling, k: int) -> Course[None]:
        begun.append(k)
        try:
            yield from chain(work, 2, 2)
        finally:
            ended.append(k)

    interruptions = 0
    for at in range(1, 400):
        begun.clear()
        ended.clear()
        work = Doubling()
        before = sys.gettrace()
        sys.settrace(Interrupted(at))
        try:
            results([counted(work, k) for k in range(4)], 3)
        except KeyboardInterrupt:
            interruptions += 1
        finally:
            sys.settrace(before)
        assert sorted(ended) == sorted(begun), f"line {at}"
    assert interruptions > 50


def test_a_clock_counts_ones_own_time_and_ones_share_of_the_work() -> None:
    def timed(work: Doubling) -> Course[float]:
        begun = lockstep.clock()
        yield from chain(work, 2, 3)
        return lockstep.clock() - begun

    found = results([timed(Doubling()) for _ in range(4)], 50)
    assert all(3000 <= seconds < 3001 for seconds in found.values())
