"""Tasks to results: what is kept is taken up, what is damaged is done again, by one or more."""

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_report_command import ended
from tests.helpers.constructed.plans import kept_in, plain
from verify.errors import InputError
from verify.execution import execute as execution
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS, Placement
from verify.execution.plan import Plan
from verify.scenes.frozen import Frozen
from verify.studies.kinds.proofs import ProofTask


def count_tasks(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The tasks that are performed in this process from now on."""
    seen: list[Any] = []
    perform = execution.compute_all

    def counting(task: Any, *more: Any) -> list[tuple[str, Frozen]]:
        seen.append(task)
        return perform(task, *more)

    monkeypatch.setattr(execution, "compute_all", counting)
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


@pytest.mark.left_to_ci
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
