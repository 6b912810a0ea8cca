"""Tasks to results: what is kept is taken up, what is damaged is done again, nothing is half."""

import contextlib
import errno
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_report_command import ended
from tests.paths import ROOT
from tests.unit.scenes.test_scene import DUFFING, GRID, SERIES, load
from verify import content as shipped
from verify.errors import InputError
from verify.execution import execute as execution
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS, Placement
from verify.execution.keeping import fingerprint
from verify.execution.plan import Plan
from verify.files import write_atomically
from verify.scenes.frozen import Frozen
from verify.studies.plan import plan_scenes
from verify.studies.proofs.one import ProofTask

CONTENT = (
    DUFFING.replace('"lie2"', '"lie2", "lie3"')
    + 'parameters = { delta = "7/3" }\n'
    + GRID.replace("time = 1", "steps = 50").replace("[0.1]", "[0.1, 0.05]")
    + SERIES
)


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    made = plan_scenes([load(tmp_path, CONTENT)])
    assert len(made.tasks) == 8
    return made


def kept_in(folder: Path) -> Store:
    return Store(folder / "kept")


def plain(results: dict[str, Frozen]) -> dict[str, dict[str, Any]]:
    """The results without their run times."""
    return {name: r.model_dump(exclude={"seconds"}) for name, r in results.items()}


def count_tasks(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The tasks that are performed in this process from now on."""
    seen: list[Any] = []
    perform = execution.compute_task

    def counting(task: Any, *more: Any) -> Frozen:
        seen.append(task)
        return perform(task, *more)

    monkeypatch.setattr(execution, "compute_task", counting)
    return seen


# -- what is kept ---------------------------------------------------------------------------------


def test_every_task_is_performed_once_and_its_result_kept(
    tmp_path: Path, plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = count_tasks(monkeypatch)
    results = execute(plan, kept_in(tmp_path), where=THIS_PROCESS)
    assert set(results) == set(plan.tasks)
    assert sorted(map(str, seen)) == sorted(map(str, plan.tasks.values()))
    files = list((tmp_path / "kept").iterdir())
    assert len(files) == len(plan.tasks)
    assert all(f.suffix == ".json" for f in files)


def test_kept_results_are_taken_up_and_nothing_is_done_again(
    tmp_path: Path, plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = execute(plan, kept_in(tmp_path), where=THIS_PROCESS)
    seen, told = count_tasks(monkeypatch), []
    again = execute(
        plan, kept_in(tmp_path), where=THIS_PROCESS, done=lambda name, _: told.append(name)
    )
    assert seen == []
    assert again == first, "even the seconds are those of the first time"
    assert sorted(told) == sorted(plan.tasks)


def test_what_is_missing_alone_is_done(
    tmp_path: Path, plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = kept_in(tmp_path)
    first = execute(plan, store, where=THIS_PROCESS)
    missing = sorted(plan.tasks)[:3]
    for name in missing:
        path = store.path(name)
        assert path is not None
        path.unlink()
    seen = count_tasks(monkeypatch)
    assert plain(execute(plan, store, where=THIS_PROCESS)) == plain(first)
    assert sorted(map(str, seen)) == sorted(str(plan.tasks[n]) for n in missing)


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda _: b"",
    "cut-short": lambda content: content[: len(content) // 2],
    "cut-by-one": lambda content: content[:-1],
    "zeros": lambda content: bytes(len(content)),
    "not-utf8": lambda content: content.replace(b"scheme", b"sch\xe9me"),
    "another-object": lambda _: b'{"a": 1}',
    "a-list": lambda _: b"[]",
    "nested": lambda _: b"[" * 100_000,
    "unknown-key": lambda content: content.replace(b'"scheme"', b'"speed": 1,\n "scheme"'),
    "not-a-number": lambda content: content.replace(b'"value": "', b'"value": "x').replace(
        b'"order": ', b'"order": x'
    ),
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_result_is_computed_again_and_mended(
    tmp_path: Path, plan: Plan, damage: Callable[[bytes], bytes]
) -> None:
    store = kept_in(tmp_path)
    first = execute(plan, store, where=THIS_PROCESS)
    for file in (tmp_path / "kept").iterdir():
        before = file.read_bytes()
        file.write_bytes(damage(before))
        assert file.read_bytes() != before
    assert plain(execute(plan, store, where=THIS_PROCESS)) == plain(first)
    for name, task in plan.tasks.items():
        kept = store.get(name, task)
        assert kept is not None
        assert plain({name: kept})[name] == plain(first)[name]


def test_a_store_without_a_folder_keeps_nothing(tmp_path: Path, plan: Plan) -> None:
    before = sorted(tmp_path.rglob("*"))
    execute(plan, Store(None), where=THIS_PROCESS)
    assert sorted(tmp_path.rglob("*")) == before


def test_an_interruption_keeps_what_was_finished(
    tmp_path: Path, plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    finished: list[str] = []

    def interrupt(name: str, _: object) -> None:
        finished.append(name)
        if len(finished) == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        execute(plan, kept_in(tmp_path), where=THIS_PROCESS, done=interrupt)
    seen = count_tasks(monkeypatch)
    execute(plan, kept_in(tmp_path), where=THIS_PROCESS)
    assert len(seen) == len(plan.tasks) - 3
    assert not {str(plan.tasks[n]) for n in finished} & set(map(str, seen))


# -- the source is part of a result's name --------------------------------------------------------


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the package and of its content, of which the fingerprint is then made."""
    root = tmp_path / "copy"
    for folder in ("verify", "reports", "reference"):
        shutil.copytree(ROOT / folder, root / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", root)
    monkeypatch.setattr(shipped, "_package", lambda: root / "verify")
    fingerprint.cache_clear()
    yield root
    monkeypatch.undo()
    fingerprint.cache_clear()


def fresh() -> str:
    fingerprint.cache_clear()
    return fingerprint()


def one_file_of_each_folder() -> list[str]:
    """Of each folder of the package, whatever kind of file, and of each folder of the content."""
    files: dict[Path, Path] = {}
    for folder in ("verify", "reports", "reference"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                files.setdefault(path.parent, path)
    return [str(path.relative_to(ROOT)) for path in files.values()]


@pytest.mark.left_to_ci
def test_the_fingerprint_covers_every_room_and_all_data(copy: Path) -> None:
    first = fresh()
    assert first == fresh(), "the same code has the same name"
    names = one_file_of_each_folder()
    assert set(names) <= set(shipped.shipped_files()), "of which it is the digest"
    rooms = {Path(name).parts[:2]: name for name in names}
    assert len([room for room in rooms if room[0] == "verify"]) >= 18
    seen = {first}
    for name in rooms.values():
        raw = (copy / name).read_bytes()
        (copy / name).write_bytes(raw + b" ")
        seen.add(fresh())
        (copy / name).write_bytes(raw)
    assert len(seen) == len(rooms) + 1, "each change gives another name"
    assert fresh() == first
    (copy / "verify" / "algebra" / "new.py").touch()
    assert fresh() not in seen, "and so does a file that is new"


def test_a_wheel_and_its_checkout_have_one_fingerprint(copy: Path) -> None:
    checkout = fresh()
    for folder in ("reports", "reference"):
        shutil.move(copy / folder, copy / "verify" / "data" / folder)
    assert fresh() == checkout


def test_what_python_writes_itself_does_not_count(copy: Path) -> None:
    first = fresh()
    (copy / "verify" / "algebra" / "__pycache__").mkdir()
    (copy / "verify" / "algebra" / "__pycache__" / "ring.pyc").write_bytes(b"compiled")
    assert fresh() == first


def test_another_source_does_not_take_up_the_results_of_this_one(
    tmp_path: Path, plan: Plan, copy: Path
) -> None:
    store = kept_in(tmp_path)
    execute(plan, store, where=THIS_PROCESS)
    assert all(store.get(name, task) is not None for name, task in plan.tasks.items())
    path = copy / "verify" / "schemes" / "methods" / "taylor" / "lie.py"
    path.write_text(path.read_text() + "\n")
    fresh()
    assert all(store.get(name, task) is None for name, task in plan.tasks.items())


# -- atomic writes --------------------------------------------------------------------------------


class FullDisk:
    """An open file on which every write fails."""

    def __init__(self, handle: int, *_: Any, **__: Any) -> None:
        self.handle = handle

    def __enter__(self) -> "FullDisk":
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self.handle)

    def write(self, _: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")


def fail(error: BaseException) -> Callable[..., None]:
    def failing(*_: Any, **__: Any) -> None:
        raise error

    return failing


FAILURES: dict[str, tuple[str, Any]] = {
    "disk-full-at-write": ("fdopen", FullDisk),
    "disk-full-at-sync": ("fsync", fail(OSError(errno.ENOSPC, "No space left on device"))),
    "replace-fails": ("replace", fail(OSError(errno.EACCES, "Permission denied"))),
    "interrupted-at-sync": ("fsync", fail(KeyboardInterrupt())),
    "interrupted-at-replace": ("replace", fail(KeyboardInterrupt())),
}


@pytest.mark.parametrize(("function", "failure"), FAILURES.values(), ids=FAILURES)
@pytest.mark.parametrize("old", ["the old content", None], ids=["over-a-file", "a-new-file"])
def test_a_failed_write_leaves_the_old_content_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, old: str | None, function: str, failure: Any
) -> None:
    path = tmp_path / "results.json"
    if old is not None:
        write_atomically(path, old)
    with monkeypatch.context() as patch:
        patch.setattr(os, function, failure)
        with pytest.raises((OSError, KeyboardInterrupt)):
            write_atomically(path, "the new content")
    assert [f.name for f in tmp_path.iterdir()] == ([path.name] if old is not None else [])
    assert old is None or path.read_text() == old
    write_atomically(path, "δ the new content")
    assert path.read_text(encoding="utf-8") == "δ the new content"


# -- workers --------------------------------------------------------------------------------------


def test_two_workers_find_what_one_finds(tmp_path: Path, plan: Plan) -> None:
    one = execute(plan, Store(None), where=THIS_PROCESS)
    two = execute(plan, kept_in(tmp_path), where=Placement(2))
    assert plain(two) == plain(one)
    assert len(list((tmp_path / "kept").iterdir())) == len(plan.tasks)


@pytest.mark.parametrize("workers", [1, 2])
def test_bad_input_found_by_a_worker_is_still_an_input_error(workers: int) -> None:
    plan = Plan()
    rough = "p_next = p - q*sqrt(h); q_next = q"
    plan.need(ProofTask(hamiltonian="p**2/2 + q**2/2", parameters={}, scheme=rough), "asked")
    with pytest.raises(InputError, match="not smooth in h"):
        execute(plan, Store(None), where=Placement(workers))


INTERRUPTED = """
import sys, time
from fractions import Fraction
from verify.execution.execute import Store, execute
from verify.execution.executors import Placement
from verify.execution.plan import Plan
from verify.runs.task import RunTask

def stop(name, result):
    raise KeyboardInterrupt

if __name__ == "__main__":
    plan = Plan()
    for k in range(1, 4):
        plan.need(RunTask(hamiltonian="p**2/2 - cos(q)", parameters={}, scheme="lie2",
            step_size=Fraction(1, 100), steps=10**11 if k == 1 else 10**3, q=Fraction(k), p=0,
            arithmetic="float64", digits=17, observables=("mse",), points=0), "asked")
    try:
        execute(plan, Store(None), where=Placement(2), done=stop)
    except KeyboardInterrupt:
        sys.exit(130)
"""


def test_an_interruption_between_two_results_ends_the_workers_at_once(tmp_path: Path) -> None:
    """One worker is at a task of an hour while the results of the other are taken in."""
    script = tmp_path / "interrupted.py"
    script.write_text(INTERRUPTED)
    with subprocess.Popen([sys.executable, script], start_new_session=True) as process:
        try:
            assert process.wait(timeout=40) == 130
            assert ended(process.pid), "the workers go on after the interruption"
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def test_the_folder_of_what_is_kept_is_looked_through_once_and_not_for_each_task(
    plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A scene of 10⁴ runs would look at 10⁸ names."""
    looks: list[Path] = []
    for name in ("glob", "iterdir"):
        original: Callable[..., Any] = getattr(Path, name)

        def counted(self: Path, *more: Any, original: Callable[..., Any] = original) -> Any:
            looks.append(self)
            return original(self, *more)

        monkeypatch.setattr(Path, name, counted)
    execute(plan, kept_in(tmp_path), where=THIS_PROCESS)
    assert [path for path in looks if path == tmp_path / "kept"] == [tmp_path / "kept"]


def test_checkpoints_of_a_task_that_another_process_left_go_when_it_is_done(
    plan: Plan, tmp_path: Path
) -> None:
    store, name = kept_in(tmp_path), next(iter(plan.tasks))
    (tmp_path / "kept").mkdir()
    left = tmp_path / "kept" / f"{name}-{'0' * 12}-{'1' * 12}.checkpoint"
    other = tmp_path / "kept" / f"another-{'0' * 12}-{'1' * 12}.checkpoint"
    for path in (left, other):
        path.write_text("{}")
    execute(plan, store, where=THIS_PROCESS)
    assert not left.exists()
    assert other.exists()
