"""Tasks on a Dask cluster of this machine: what is found is the same, whoever is lost meanwhile."""

import os
import signal
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import SCENE, here
from tests.end_to_end.test_report_command import (
    findings,
    interrupt,
    kept,
    provenance,
    started,
    wait_for_one_kept,
)
from tests.helpers.constructed.plans import CONTENT, kept_in, plain
from tests.helpers.constructed.scenes import DUFFING, load
from tests.helpers.processes.local_cluster import local_cluster
from tests.helpers.processes.worker_functions import (
    collect,
    killed,
    killed_once,
    process,
    right,
    square,
    squares,
    wrong,
)
from verify.errors import InputError, PlaceError
from verify.execution import cluster as clusters
from verify.execution import executors
from verify.execution.cluster import connect
from verify.execution.execute import execute
from verify.execution.executors import THIS_PROCESS, FunctionCall, Placement, open_place, results_of
from verify.execution.provenance import machine
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.studies.kinds.work_precision import WorkPrecisionTask
from verify.studies.tasks_of_scenes import plan_scenes

pytestmark = pytest.mark.left_to_ci

distributed = pytest.importorskip("distributed")
GIVEN_UP = 1  # workers that may be lost with a task, so that a test of it is short


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with local_cluster(**{"distributed.scheduler.allowed-failures": GIVEN_UP}) as made:
        yield made


@pytest.fixture
def address(cluster: Any) -> str:
    """Of the scheduler, both of whose workers are there, also after a test that has killed one."""
    with distributed.Client(cluster, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=30)
    return str(cluster.scheduler_address)


# -- what is found --------------------------------------------------------------------------------


def test_a_cluster_finds_what_this_process_finds(address: str, tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, CONTENT)])
    there = execute(plan, kept_in(tmp_path), where=Placement(cluster=address))
    assert plain(there) == plain(execute(plan, kept_in(tmp_path / "own"), where=THIS_PROCESS))
    assert len(list((tmp_path / "kept").iterdir())) == len(plan.tasks)


def test_a_report_is_the_same_by_one_by_two_and_by_a_cluster(
    capsys: pytest.CaptureFixture[str], address: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(SCENE)
    given = {"one": ("--workers", "1"), "two": ("--workers", "2"), "c": ("--cluster", address)}
    for name, where in given.items():
        call = ("report", str(path), "-o", str(tmp_path / name), *where)
        status, _, err = here(capsys, *call)
        assert (status, err) == (0, "")
    one, two, there = (tmp_path / name for name in given)
    assert findings(one) == findings(two) == findings(there)
    names = [[f.name for f in kept(folder)] for folder in (one, two, there)]
    assert names[0] == names[1] == names[2]
    assert provenance(one).machine == machine()
    assert provenance(there).machine == f"{machine()}, and a cluster"


def test_times_are_measured_there_one_after_another(address: str, tmp_path: Path) -> None:
    """Two tasks of times and others: each time is of the worker's machine, and says so."""
    section = (
        "[work_precision]\ntime = 1\nstep_sizes = [0.5, 0.25]\nrepeats = 1\npeers = false\n"
        "initial_value = { q = 1, p = 0 }\nnumber_systems = []\n"
    )
    texts = [DUFFING + f"parameters = {{ delta = {k} }}\n" + section for k in (1, 2)]
    plan = plan_scenes([load(tmp_path, text) for text in texts])
    timed = {name for name, task in plan.tasks.items() if isinstance(task, WorkPrecisionTask)}
    order: list[str] = []

    def done(name: str, _: object) -> None:
        order.append(name)

    found = execute(plan, kept_in(tmp_path), where=Placement(cluster=address), done=done)
    assert len(timed) == 2
    assert set(order[-2:]) == timed, "when all others are done"
    for name in timed:
        result = found[name]
        assert isinstance(result, WorkPrecisionResult)
        assert result.machine == machine()


def test_one_by_one_no_two_are_under_way(address: str, tmp_path: Path) -> None:
    log = tmp_path / "log"
    with open_place(Placement(cluster=address)) as place:
        calls = squares(4, 0.1, str(log))
        for count, _ in enumerate(results_of(place, calls, one_by_one=True), 1):
            assert len(log.read_text().splitlines()) == count


def test_what_a_task_raises_there_is_raised_here(address: str, tmp_path: Path) -> None:
    found: list[tuple[str, int]] = []
    flag = tmp_path / "flag"
    calls = [*squares(1), FunctionCall("wrong", wrong, (str(flag),))]
    with pytest.raises(ValueError, match="wrong input"):
        collect(found, Placement(cluster=address), calls, flag, after=1)
    assert right(found, 1)


# -- lost workers ---------------------------------------------------------------------------------


def test_nothing_is_lost_or_doubled_when_a_worker_is_killed(address: str, tmp_path: Path) -> None:
    log, found = tmp_path / "log", list[tuple[str, int]]()
    with open_place(Placement(cluster=address)) as place:
        for each in results_of(place, squares(24, 0.1, str(log))):
            found.append(each)
            if len(found) == 6:
                os.kill(int(log.read_text().split()[-1]), signal.SIGKILL)
    assert right(found, 24)
    assert len({line.split()[1] for line in log.read_text().splitlines()}) >= 2


def test_a_plan_whose_worker_is_killed_finds_the_same(address: str, tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, CONTENT.replace("steps = 50", "steps = 5000"))])
    with open_place(Placement(cluster=address)) as place:
        ids = {
            pid for _, pid in results_of(place, [FunctionCall(str(k), process) for k in range(4)])
        }
    done: list[str] = []

    def kill(name: str, _: object) -> None:
        done.append(name)
        if len(done) == 2:
            os.kill(min(ids), signal.SIGKILL)

    found = execute(plan, kept_in(tmp_path), where=Placement(cluster=address), done=kill)
    assert sorted(done) == sorted(plan.tasks), "each is told once"
    assert plain(found) == plain(execute(plan, kept_in(tmp_path / "own"), where=THIS_PROCESS))


def test_a_task_that_loses_its_worker_once_is_done_by_another(address: str, tmp_path: Path) -> None:
    found: list[tuple[str, Any]] = []
    calls = [FunctionCall("twice", killed_once, (str(tmp_path / "flag"),)), *squares(4)]
    collect(found, Placement(cluster=address), calls)
    assert dict(found).pop("twice") == "well"
    assert right([each for each in found if each[0] != "twice"], 4)


def test_a_task_that_always_loses_its_worker_is_named_and_no_other(address: str) -> None:
    """Dask also gives up those that waited at its workers; they are not what is blamed."""
    found: list[tuple[str, int]] = []
    calls = [*squares(3, 0.1), FunctionCall("x", killed, description="run of lie2")]
    with pytest.raises(PlaceError, match=r"^run of lie2: its worker was lost again") as caught:
        collect(found, Placement(cluster=address), calls)
    assert "\n" not in str(caught.value)
    assert all(value == int(name) ** 2 for name, value in found)
    assert len(dict(found)) == len(found)


def test_an_interrupted_report_goes_on_and_its_results_are_not_touched(
    capsys: pytest.CaptureFixture[str], address: str, tmp_path: Path
) -> None:
    path = tmp_path / "long.toml"
    path.write_text(SCENE.replace("steps = 200", "steps = 20000"))
    whole, folder = tmp_path / "whole", tmp_path / "out"
    assert here(capsys, "report", str(path), "-o", str(whole), "--workers", "1")[0] == 0
    call = ("report", str(path), "-o", str(folder), "--cluster", address)
    with started(*call) as begun:
        wait_for_one_kept(begun, folder)
        status, out, err = interrupt(begun)
    assert (status, out) == (130, ""), err
    before = {file: file.read_bytes() for file in kept(folder)}
    assert 1 <= len(before) < 11
    assert err.count("\n") == 1, err
    assert f"{len(before)} of 11 tasks are kept" in err
    assert {f.suffix for f in (folder / "kept").iterdir()} == {".json"}, "no checkpoint, no rest"
    status, _, err = here(capsys, *call)
    assert (status, err) == (0, "")
    assert {file: file.read_bytes() for file in before} == before
    assert provenance(folder).kept == len(before)
    assert findings(folder) == findings(whole)


@pytest.mark.parametrize(
    ("gone", "said"),
    [
        ("workers", "has had no worker for a minute"),
        ("scheduler", "is gone, or has been restarted"),
    ],
)
def test_a_cluster_that_ends_is_told_and_not_waited_for(
    monkeypatch: pytest.MonkeyPatch, gone: str, said: str
) -> None:
    monkeypatch.setattr(clusters, "_CHECK_SECONDS", 0.1)
    monkeypatch.setattr(clusters, "_MAX_SECONDS_WITHOUT_WORKER", 0.3)
    monkeypatch.setattr(executors, "_CHECK_SECONDS", 0.1)
    found: list[tuple[str, int]] = []
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, protocol="tcp", dashboard_address=":0"
    ) as made:
        calls = (
            FunctionCall(name, square, (3, seconds)) for name, seconds in _ending(made, gone, found)
        )
        with pytest.raises(PlaceError, match=said):
            collect(found, Placement(cluster=made.scheduler_address), calls)
    assert found[0] == ("0", 9), "what was finished is not lost"


def _ending(cluster: Any, gone: str, found: list[Any]) -> Iterator[tuple[str, float]]:
    """Names and seconds of calls; with the first result there, the cluster ends."""
    for k in range(100):
        if found and gone == "workers":
            cluster.scale(0)
        elif found:
            cluster.close()
        yield str(k), 0.2


# -- addresses ------------------------------------------------------------------------------------


@pytest.fixture
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clusters, "_CONNECT_SECONDS", 1.0)


def refused(address: str) -> str:
    begun = time.monotonic()
    with pytest.raises(InputError) as caught, connect(address):
        pass
    assert time.monotonic() - begun < 8
    assert str(caught.value).startswith("cluster=tcp://127.0.0.1")
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.usefixtures("hasty")
def test_an_address_where_nobody_answers_is_bad_input() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    assert "no Dask scheduler answers there within 1 s" in refused(f"tcp://127.0.0.1:{port}")
    with socket.socket() as mute:
        mute.bind(("127.0.0.1", 0))
        mute.listen()
        said = refused(f"tcp://127.0.0.1:{mute.getsockname()[1]}")
    assert "no Dask scheduler answers" in said


def test_a_workers_address_is_bad_input(cluster: Any, address: str) -> None:
    worker = next(iter(cluster.scheduler_info["workers"]))
    assert "is a Dask worker; the scheduler's is needed" in refused(worker)


@pytest.mark.usefixtures("hasty")
def test_a_cluster_without_workers_is_bad_input() -> None:
    with distributed.LocalCluster(n_workers=0, dashboard_address=":0") as empty:
        said = refused(empty.scheduler_address)
    assert "has no workers; start one: dask worker" in said


def test_a_worker_with_other_code_is_named(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clusters, "fingerprint", _another)
    assert "not the same at tcp://127.0.0.1" in refused(address)


def _another() -> str:
    """Of each process another one: as where the workers have other code."""
    return str(os.getpid())


@pytest.mark.parametrize("command", ["report", "check", "stability", "flow", "bench"])
def test_every_command_with_tasks_refuses_a_bad_address(
    capsys: pytest.CaptureFixture[str], command: str
) -> None:
    status, out, err = here(capsys, command, "paper", "--cluster", "nowhere")
    assert (status, out) == (2, "")
    assert err.startswith("verify: --cluster=nowhere: must be the address of a Dask scheduler")
    assert err.count("\n") == 1


def test_workers_and_a_cluster_do_not_go_together(capsys: pytest.CaptureFixture[str]) -> None:
    both = ("--workers", "2", "--cluster", "tcp://127.0.0.1:8786")
    status, out, err = here(capsys, "report", "paper", *both)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "leave out --workers" in err
