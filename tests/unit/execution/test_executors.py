"""Calls in this process and in others: each result once, as it comes; lost workers are replaced."""

import concurrent.futures
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from multiprocessing import forkserver
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.processes.worker_functions import (
    collect,
    killed,
    killed_once,
    loaded,
    process,
    right,
    square,
    squares,
    wrong,
)
from tests.paths import ROOT
from verify.errors import InputError, PlaceError
from verify.execution.executors import (
    LOCAL_DEFAULT,
    THIS_PROCESS,
    FunctionCall,
    Placement,
    call_in_worker,
    open_place,
    results_of,
)
from verify.execution.keeper import fingerprint


class Finished:
    """A place where each call is finished as soon as it is sent; `lose` loses its worker."""

    local, attempts, names_lost_call, room = True, 1, True, 9

    def submit(self, function: Callable[..., Any], *arguments: Any) -> "Future[Any]":
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments))
        except (ValueError, ConnectionError) as error:
            future.set_exception(error)
        return future

    def release(self, future: "Future[Any]") -> None: ...

    def is_worker_loss(self, error: BaseException) -> bool:
        return isinstance(error, ConnectionError)

    def check(self) -> None: ...


def lose() -> None:
    raise ConnectionError


# -- where ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("workers", "cluster", "named"),
    [
        (0, None, "workers=0"),
        (-2, None, "workers=-2"),
        (2, "tcp://here:8786", "cluster=tcp://here:8786: has its own workers"),
        (None, "", "cluster="),
        (None, "here:8786", "cluster=here:8786"),
        (None, "tcp://here", "cluster=tcp://here"),
        (None, "http://here:8786", "cluster=http://here:8786"),
        (None, "tcp://here:8786/status", "cluster=tcp://here:8786/status"),
        (None, "inproc://1/2/3", "cluster=inproc"),
    ],
)
def test_a_place_that_cannot_be_is_bad_input(
    workers: int | None, cluster: str | None, named: str
) -> None:
    with pytest.raises(InputError, match=named) as caught:
        Placement(workers, cluster)
    assert "\n" not in str(caught.value)


def test_a_place_that_can_be_is_none() -> None:
    assert Placement() == LOCAL_DEFAULT
    assert Placement(1) == THIS_PROCESS
    for address in ("tcp://10.0.0.1:8786", "tls://here.org:1", "tcp://[::1]:8786"):
        assert Placement(cluster=address).cluster == address


def test_without_distributed_the_error_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with (
        pytest.raises(InputError, match=r"pip install 'areaproof\[cluster\]'"),
        open_place(Placement(cluster="tcp://127.0.0.1:1")),
    ):
        pass


def test_distributed_is_imported_for_a_cluster_only() -> None:
    code = (
        "import sys; from verify.execution.executors import *; from verify.commands import main\n"
        "from verify.execution import cluster, execute\n"
        "from tests.helpers.processes.worker_functions import square\n"
        "if __name__ == '__main__':\n"
        "    for n in (1, 2):\n"
        "        with open_place(Placement(n)) as place:\n"
        "            call = FunctionCall('a', square, (3,))\n"
        "            assert list(results_of(place, [call])) == [('a', 9)]\n"
        "    assert not {'distributed', 'dask', 'tornado'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


# -- results --------------------------------------------------------------------------------------


@pytest.mark.parametrize("workers", [1, 2])
def test_each_result_is_yielded_once_under_its_name(workers: int) -> None:
    with open_place(Placement(workers)) as place:
        assert right(list(results_of(place, squares(30))), 30)
        assert right(list(results_of(place, squares(5), one_by_one=True)), 5), "and again"
        assert list(results_of(place, [])) == []


def test_no_more_calls_are_taken_than_there_is_room_for() -> None:
    """So that a million calls are never in memory."""
    taken = 0

    def calls() -> Iterator[FunctionCall]:
        nonlocal taken
        for call in squares(20):
            taken += 1
            yield call

    with open_place(Placement(2)) as place:
        for count, _ in enumerate(results_of(place, calls()), start=1):
            assert taken <= count + 2 * place.room
        assert taken == 20


def test_one_by_one_no_two_are_under_way(tmp_path: Path) -> None:
    log = tmp_path / "log"
    with open_place(Placement(2)) as place:
        for count, _ in enumerate(results_of(place, squares(4, 0.1, str(log)), one_by_one=True), 1):
            assert len(log.read_text().splitlines()) == count


def test_what_a_call_raises_is_raised_and_what_was_found_is_not_lost(tmp_path: Path) -> None:
    found: list[tuple[str, int]] = []
    flag = tmp_path / "flag"
    calls = [FunctionCall("wrong", wrong, (str(flag),)), *squares(3)]
    with pytest.raises(ValueError, match="wrong input"):
        collect(found, Placement(2), calls, flag, after=3)
    assert right(found, 3)


@pytest.mark.parametrize("at", range(4))
@pytest.mark.parametrize(("function", "error"), [(wrong, ValueError), (lose, PlaceError)])
def test_what_is_finished_beside_a_call_that_fails_is_yielded(
    at: int, function: Callable[[], None], error: type[Exception]
) -> None:
    calls, found = squares(3), list[tuple[str, int]]()
    calls.insert(at, FunctionCall("bad", function))
    with pytest.raises(error):
        found.extend(results_of(Finished(), calls))
    assert right(found, 3)


def test_after_an_interruption_what_is_finished_is_yielded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found: list[tuple[str, int]] = []

    def interrupted(futures: dict[Future[Any], FunctionCall], **_: object) -> None:
        concurrent.futures.wait(futures)
        raise KeyboardInterrupt

    monkeypatch.setattr("verify.execution.executors.wait", interrupted)
    with pytest.raises(KeyboardInterrupt):
        collect(found, Placement(2), squares(9))
    assert right(found, 2)


def test_other_code_in_a_worker_is_an_error() -> None:
    assert call_in_worker(fingerprint(), square, (3,)) == 9
    with pytest.raises(PlaceError, match=f"process {os.getpid()}: its areaproof") as caught:
        call_in_worker("0" * 12, square, (3,))
    assert "\n" not in str(caught.value)


# -- lost workers ---------------------------------------------------------------------------------


def test_nothing_is_lost_or_done_twice_when_a_worker_is_killed(tmp_path: Path) -> None:
    log = tmp_path / "log"
    found: list[tuple[str, int]] = []
    with open_place(Placement(2)) as place:
        for each in results_of(place, squares(12, 0.1, str(log))):
            found.append(each)
            if len(found) == 4:  # that one has begun last, and is at it
                victim = int(log.read_text().split()[-1])
                os.kill(victim, signal.SIGKILL)
    assert right(found, 12)
    begun = [int(line.split()[0]) for line in log.read_text().splitlines()]
    assert len(begun) - len(set(begun)) <= 1, "only what was lost was begun again"
    assert len({line.split()[1] for line in log.read_text().splitlines()}) == 3


def test_a_worker_that_is_lost_while_it_is_idle_costs_nothing() -> None:
    with open_place(Placement(2)) as place:
        ids = {
            pid for _, pid in results_of(place, [FunctionCall(str(k), process) for k in range(2)])
        }
        for pid in ids:
            os.kill(pid, signal.SIGKILL)
        assert right(list(results_of(place, squares(6))), 6)


def test_a_call_that_loses_its_worker_once_is_done_by_another(tmp_path: Path) -> None:
    calls = [FunctionCall("twice", killed_once, (str(tmp_path / "flag"),)), *squares(4)]
    with open_place(Placement(2)) as place:
        found = dict(results_of(place, calls))
    assert found.pop("twice") == "well"
    assert right(list(found.items()), 4)


def test_a_call_that_always_loses_its_worker_is_named_and_no_other_is_lost(tmp_path: Path) -> None:
    found: list[tuple[str, int]] = []
    flag = tmp_path / "flag"  # what is still under way when a call is given up is not waited for
    calls = [*squares(2), FunctionCall("x", killed, (str(flag),), "run of lie2")]
    with pytest.raises(PlaceError, match=r"^run of lie2: its worker was lost again"):
        collect(found, Placement(2), calls, flag, after=2)
    assert right(found, 2)


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("methods", "begun"), [(None, "forkserver"), (["spawn"], "spawn_main")])
def test_workers_are_forked_beside_this_process_from_one_that_has_imported_what_they_need(
    methods: list[str] | None, begun: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if methods is not None:
        monkeypatch.setattr(multiprocessing, "get_all_start_methods", lambda: methods)
    forkserver._forkserver._stop()  # there is one for all places, and an earlier test's has less
    calls = [FunctionCall("pid", process), FunctionCall("has", loaded, ("sympy",))]
    with open_place(Placement(2), ["sympy"]) as place:
        found = dict(results_of(place, calls))
        assert begun in Path(f"/proc/{found['pid']}/cmdline").read_text()
    assert found["has"] is (methods is None)


def test_workers_end_when_their_parent_is_killed() -> None:
    """It cannot end them then; nor would they see by themselves that no more calls come."""
    parent = subprocess.Popen(
        [sys.executable, "-c", _HAS_WORKERS], stdout=subprocess.PIPE, text=True, cwd=ROOT
    )
    with parent:
        assert parent.stdout is not None
        workers = [int(pid) for pid in parent.stdout.readline().split()]
        assert len(workers) == 2
        parent.kill()
    until = time.monotonic() + 30
    while any(map(alive, workers)):
        assert time.monotonic() < until, "orphans"
        time.sleep(0.1)


_HAS_WORKERS = """
import time
from tests.helpers.processes.worker_functions import process
from verify.execution.executors import FunctionCall, Placement, open_place, results_of

if __name__ == "__main__":
    with open_place(Placement(2)) as place:
        calls = [FunctionCall(str(k), process) for k in range(2)]
        print(*{pid for _, pid in results_of(place, calls)}, flush=True)
        time.sleep(60)
"""


def alive(pid: int) -> bool:
    """Whether there is such a process; one that ended and was not waited for is none."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"
