"""Functions in lockstep give what each gives by itself, and end where nobody waits for them."""

import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import pytest

from verify import lockstep
from verify.lockstep import Pending, meet, together


class Doubling:
    """Doubles numbers, all that are asked of it at once; odd ones take two times."""

    def __init__(self) -> None:
        self.sizes: list[int] = []

    def advance(self, pending: Sequence[Pending]) -> None:
        self.sizes.append(len(pending))
        for each in pending:
            if each.asked < 0:
                each.end(None, ValueError(f"{each.asked} is negative"))
            elif each.asked % 2 and each.state is None and len(pending) > 1:
                each.state = "begun"
            else:
                each.seconds += 1000.0
                each.end(2 * each.asked)


class Four(Doubling):
    """Takes four at most, and notes how many."""

    def advance(self, pending: Sequence[Pending]) -> None:
        super().advance(pending[:4])


def chain(work: Doubling, start: int, times: int) -> int:
    for _ in range(times):
        start = meet(work, start).result + 1
    return start


def results(functions: Sequence[Callable[[], Any]], most: int) -> dict[int, Any]:
    return {number: future.result() for number, future in together(iter(functions), most)}


@pytest.mark.parametrize("most", [1, 2, 3, 50])
def test_each_gives_what_it_gives_by_itself(most: int) -> None:
    calls = [partial(chain, Doubling(), k, k % 4) for k in range(20)]
    work = Doubling()
    found = results([partial(chain, work, k, k % 4) for k in range(20)], most)
    assert found == {k: call() for k, call in enumerate(calls)}
    assert max(work.sizes) <= most


def test_what_is_asked_at_once_is_done_together() -> None:
    work = Doubling()
    results([partial(chain, work, 2 * k, 1) for k in range(7)], 50)
    assert work.sizes == [7]


def test_the_work_that_is_waited_for_longest_is_done_first() -> None:
    one, other = Doubling(), Doubling()
    order: list[str] = []
    for name, work in (("one", one), ("other", other)):
        advance = work.advance
        work.advance = lambda p, n=name, f=advance: (order.append(n), f(p))[1]  # type: ignore
    results([partial(chain, one, 2, 1), *[partial(chain, other, 2, 1)] * 2], 50)
    assert order == ["one", "other"]


@pytest.mark.parametrize("count", [5, 6, 7, 15])
def test_nobody_is_left_to_go_on_alone(count: int) -> None:
    """Each needs one work, then another; both are done for four at once nearly all the time."""
    first, second = Four(), Four()

    def both() -> None:
        for work in [first] * 20 + [second] * 20:
            meet(work, 2)

    results([both] * count, 50)
    for work in (first, second):
        assert sum(work.sizes) == 20 * count
        assert len(work.sizes) <= 20 * count / 4 + 3


def test_an_error_is_that_of_its_own_function_alone() -> None:
    work = Doubling()
    ended = dict(together(iter([partial(chain, work, k, 1) for k in (2, -1, 4)]), 50))
    assert ended[0].result() == 5
    assert ended[2].result() == 9
    with pytest.raises(ValueError, match="-1 is negative"):
        ended[1].result()


def test_functions_that_meet_nobody_are_all_called() -> None:
    assert results([lambda k=k: k for k in range(9)], 2) == {k: k for k in range(9)}  # type: ignore
    assert results([], 2) == {}


def test_without_others_it_is_done_at_once() -> None:
    assert meet(Doubling(), 21).result == 42
    with pytest.raises(ValueError, match="negative"):
        meet(Doubling(), -3)


def test_those_that_wait_are_ended_where_nobody_waits_for_them() -> None:
    seen: list[str] = []

    def waiting(work: Doubling) -> None:
        try:
            chain(work, 2, 5)
        except BaseException as error:
            seen.append(type(error).__name__)
            raise
        seen.append("ended")

    work = Doubling()
    course = together(iter([lambda: 1, *[partial(waiting, work)] * 2]), 50)
    next(course)
    course.close()
    assert seen in ([], ["GreenletExit"] * 2)
    course = together(iter([partial(chain, work, 2, 1), *[partial(waiting, work)] * 2]), 50)
    next(course)
    course.close()
    assert seen[-2:] == ["GreenletExit"] * 2


@pytest.mark.parametrize("at", range(3))
def test_an_interruption_is_everybodys(at: int) -> None:
    """Ctrl-C comes while one of them runs; the others write what they have."""
    seen: list[str] = []

    def kept(work: Doubling, interrupted: bool) -> None:
        try:
            chain(work, 2, 1)
            if interrupted:
                raise KeyboardInterrupt
            chain(work, 2, 1)
        except KeyboardInterrupt:
            seen.append("kept")
            raise

    work = Doubling()
    functions = [partial(kept, work, k == at) for k in range(3)]
    with pytest.raises(KeyboardInterrupt):
        results(functions, 50)
    assert seen == ["kept"] * 3


class Interrupted:
    """A trace function that raises KeyboardInterrupt at the n-th line of `lockstep` itself."""

    def __init__(self, at: int) -> None:
        self.left = at

    def __call__(self, frame: Any, event: str, _: Any) -> Any:
        if frame.f_code.co_filename != lockstep.__file__:
            return None
        if event == "line" and frame.f_code.co_name in ("together", "go_on", "_advance"):
            self.left -= 1
            if self.left == 0:
                raise KeyboardInterrupt
        return self


def test_nobody_is_forgotten_whenever_an_interruption_comes() -> None:
    begun: list[int] = []
    ended: list[int] = []

    def counted(work: Doubling, k: int) -> None:
        begun.append(k)
        try:
            chain(work, 2, 2)
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
            results([partial(counted, work, k) for k in range(4)], 3)
        except KeyboardInterrupt:
            interruptions += 1
        finally:
            sys.settrace(before)
        assert sorted(ended) == sorted(begun), f"line {at}"
    assert interruptions > 50


def test_a_clock_counts_ones_own_time_and_ones_share_of_the_work() -> None:
    def timed(work: Doubling) -> float:
        begun = lockstep.clock()
        chain(work, 2, 3)
        return lockstep.clock() - begun

    found = results([partial(timed, Doubling()) for _ in range(4)], 50)
    assert all(3000 <= seconds < 3001 for seconds in found.values())
