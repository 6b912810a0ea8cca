"""`verify explore` on a Dask cluster: the same bytes as here, also when a worker is killed."""

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import here, json_of
from tests.helpers.processes.local_cluster import local_cluster
from verify.exploration import exploring, hunting
from verify.exploration import hunting as gallery
from verify.pages import page

pytestmark = pytest.mark.left_to_ci

distributed = pytest.importorskip("distributed")
ASKED = ("explore", "--property", "quadratic-hamiltonians", "--property", "time-scaling",
         "--scheme", "lie2", "--degree", "3", "--seed", "5", "--json")  # fmt: skip
HUNT = ("explore", "--maximise", "growth", "--examples", "6", "--steps", "10", "--degree", "2",
        "--kind", "polynomial", "--seed", "5", "--json")  # fmt: skip


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    with local_cluster() as made:
        yield made


def killed_when(folder: Path, files: int, pid: int) -> threading.Thread:
    """Kills the process once so many results are there."""

    def wait() -> None:
        until = time.monotonic() + 60
        while len(list(folder.glob("*.json"))) < files and time.monotonic() < until:
            time.sleep(0.01)
        os.kill(pid, signal.SIGKILL)

    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    return thread


def test_a_worker_killed_in_the_middle_of_a_sweep_changes_nothing(
    cluster: Any,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(exploring, "_MIN_SCENES_OF_TASK", 7)  # four stretches
    asked = (*ASKED, "--examples", "28")
    alone = here(capsys, *asked, "--workers", "1")
    folder = tmp_path / "kept"
    with distributed.Client(cluster, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=30)
        pids = list(client.run(os.getpid).values())
    killer = killed_when(folder, 1, pids[0])
    address = str(cluster.scheduler_address)
    found = here(capsys, *asked, "--cluster", address, "--keep", str(folder))
    killer.join()
    assert found == alone
    assert json_of(found[1])["examples"] == 28
    assert len(list(folder.glob("*.json"))) == 4, "each stretch once"


def test_a_hunt_finds_the_same_on_a_cluster(
    cluster: Any,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(hunting, "_SCENES_OF_ISLAND", 2)  # three islands, two of them at a time
    monkeypatch.setattr(gallery, "_LONGER_FACTOR", 10)
    monkeypatch.setattr(page, "write", lambda *_: Path("index.html"))  # of what is found here
    with distributed.Client(cluster, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=30)
    address = str(cluster.scheduler_address)
    places = {"one": ("--workers", "1"), "c": ("--cluster", address)}
    found = {}
    for name, where in places.items():
        status, out, _ = here(capsys, *HUNT, "-o", name, *where)
        assert status == 0
        shown = json_of(out)["gallery"]["scenes"]
        found[name] = [(each["value"], each["scene"]) for each in shown]
    assert found["one"] == found["c"]
    assert found["one"]
