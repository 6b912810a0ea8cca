"""No process that we start runs what lies in the folder where somebody calls `verify`."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.paths import ROOT
from verify.execution.processes import safe_path

PLANTED = sorted(
    {*sys.stdlib_module_names, "click", "distributed", "flint", "gmpy2", "llvmlite", "mpmath",
     "numpy", "pydantic", "sympy", "verify", "sitecustomize"} - {"sys", "builtins"}
)  # fmt: skip
SCENE = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2"]
[grid]
steps = 2
step_sizes = [0.01]
initial_values = [{ q = 1, p = 0 }]
"""
LOG = "executed.log"
ENTRY = """
import contextlib, multiprocessing
from verify.execution import processes
from verify.execution.executors import FunctionCall, Placement, open_place, results_of
from tests.helpers.processes.worker_functions import square
if {method!r} == "spawn":
    assert processes._fork_server
    processes._fork_server = lambda _: multiprocessing.get_context("spawn")
if {unsafe}:
    processes.safe_path = contextlib.nullcontext
if __name__ == "__main__":
    with open_place(Placement(2)) as place:
        calls = [FunctionCall(str(k), square, (k,)) for k in range(4)]
        assert place._context.get_start_method() == {method!r}
        assert len(list(results_of(place, calls))) == 4
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a file for each module that something may import; run, it says so."""
    log = tmp_path / LOG
    for name in PLANTED:
        said = (
            f"import posix\nf = posix.open({str(log)!r}, 1089, 0o600)\nposix.write(f, b'{name} ')\n"
        )
        (tmp_path / f"{name}.py").write_text(said)
    (tmp_path / "mine.toml").write_text(SCENE)
    return tmp_path


def executed(folder: Path) -> list[str]:
    log = folder / LOG
    return log.read_text().split() if log.exists() else []


def call(folder: Path, entry: Path, code: str) -> tuple[int, str]:
    """Runs the code there as an entry point's, whose own folder is first on the path."""
    entry.write_text(code)
    done = subprocess.run(
        [sys.executable, str(entry)], cwd=folder, capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    return done.returncode, done.stderr


@pytest.fixture
def entry(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("entry") / "entry.py"


@pytest.mark.parametrize("method", ["forkserver", "spawn"])
def test_neither_workers_nor_fork_server_nor_resource_tracker_run_it(
    folder: Path, entry: Path, method: str
) -> None:
    assert call(folder, entry, ENTRY.format(method=method, unsafe=False)) == (0, "")
    assert executed(folder) == []


@pytest.mark.parametrize("method", ["forkserver", "spawn"])
def test_without_the_safe_path_they_would(folder: Path, entry: Path, method: str) -> None:
    call(folder, entry, ENTRY.format(method=method, unsafe=True))
    assert executed(folder)


def test_the_environment_is_afterwards_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    for value in ("", "1", None):
        if value is None:
            monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
        else:
            monkeypatch.setenv("PYTHONSAFEPATH", value)
        with safe_path():
            assert os.environ["PYTHONSAFEPATH"] == "1"
        assert os.environ.get("PYTHONSAFEPATH") == value


def test_of_two_threads_the_last_restores_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    first, second = safe_path(), safe_path()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert os.environ["PYTHONSAFEPATH"] == "1"
    second.__exit__(None, None, None)
    assert "PYTHONSAFEPATH" not in os.environ


def report(folder: Path, *where: str) -> subprocess.CompletedProcess[str]:
    verify = str(Path(sys.executable).parent / "verify")
    return subprocess.run(
        [verify, "report", "mine.toml", "-o", "made", *where],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip


@pytest.mark.left_to_ci
def test_a_report_by_workers_runs_nothing_of_the_folder(folder: Path) -> None:
    done = report(folder, "--workers", "2")
    assert (done.returncode, done.stderr, executed(folder)) == (0, "", [])


@pytest.fixture
def address() -> Iterator[str]:
    distributed: Any = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, protocol="tcp://",
        dashboard_address=":0", silence_logs="CRITICAL",
    ) as cluster:  # fmt: skip
        yield str(cluster.scheduler_address)


@pytest.mark.left_to_ci
def test_nor_does_a_report_by_a_dask_client(folder: Path, address: str) -> None:
    done = report(folder, "--cluster", address)
    assert (done.returncode, done.stderr, executed(folder)) == (0, "", [])
