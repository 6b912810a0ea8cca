"""What of a task that is alone need not be so is found by workers, beside other tasks."""

import os
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.plans import kept_in
from tests.helpers.processes.timed_tasks import Noted, Other, Timed, lines_of
from verify.errors import InputError
from verify.execution import execute as execution
from verify.execution.execute import Store, execute, prepare_task
from verify.execution.executors import (
    LOCAL_DEFAULT,
    THIS_PROCESS,
    FunctionCall,
    Placement,
    open_place,
)
from verify.execution.plan import Plan
from verify.execution.task import Task

LONG = 10**10  # float64 steps, some 40 s
ENDS = ("begins", "ends")


def plan_of(*tasks: Task) -> Plan:
    plan = Plan()
    for task in tasks:
        plan.need(task, "asked")
    return plan


def prepared(results: dict[str, Any], *tasks: Task) -> list[str | None]:
    found = [results[task.key] for task in tasks]
    assert all(isinstance(each, Noted) for each in found)
    return [each.prepared for each in found]


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return tmp_path / "log"


def both(log: Path, **more: Any) -> tuple[list[Task], list[Task]]:
    """Two tasks that are alone, and three others."""
    alone: list[Task] = [Timed(log=str(log), number=k, **more) for k in (1, 2)]
    return alone, [Other(log=str(log), number=k) for k in (3, 4, 5)]


@pytest.mark.parametrize("folder", [True, False])
def test_workers_prepare_once_and_this_process_takes_it_up_when_nothing_else_runs(
    tmp_path: Path, log: Path, folder: bool
) -> None:
    alone, others = both(log)
    store = kept_in(tmp_path) if folder else Store(None)
    results = execute(plan_of(*alone, *others), store, where=Placement(2))
    assert prepared(results, *alone) == ["of 1", "of 2"]
    assert prepared(results, *others) == [None] * 3
    lines = lines_of(log)
    assert Counter((line.kind, line.what, line.when) for line in lines) == {
        **{("timed", what, when): 2 for what in ("prepare", "compute") for when in ENDS},
        **{("other", "compute", when): 3 for when in ENDS},
    }
    last = lines[-4:]
    assert [(x.kind, x.what, x.when) for x in last] == [("timed", "compute", x) for x in ENDS * 2]
    assert {line.process for line in last} == {os.getpid()}
    assert os.getpid() not in {line.process for line in lines[:-4]}


def test_what_is_prepared_goes_among_the_others_by_its_cost(
    log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So that no worker is left with a long one at the end.

    What counts is in which order they are handed out: a worker may be slow to start.
    """
    handed: list[FunctionCall] = []
    true = execution.results_of

    def noted(place: Any, calls: Any, **more: Any) -> Any:
        calls = list(calls)
        handed.extend(calls)
        return true(place, calls, **more)

    monkeypatch.setattr(execution, "results_of", noted)
    alone = Timed(log=str(log), number=1, worth=2 * LONG)
    others = [Other(log=str(log), number=k, worth=LONG) for k in range(2, 6)]
    execute(plan_of(*others, alone), Store(None), where=Placement(2))
    assert [call.function is prepare_task for call in handed[:5]] == [True] + 4 * [False]
    assert "prepare" in {line.what for line in lines_of(log)}


def test_in_this_process_and_with_nothing_beside_it_a_task_prepares_nothing(log: Path) -> None:
    alone, others = both(log)
    here = execute(plan_of(*alone, *others), Store(None), where=THIS_PROCESS)
    one = execute(plan_of(alone[0]), Store(None), where=Placement(2))
    assert prepared(here, *alone) == [None, None]
    assert prepared(one, alone[0]) == [None]
    assert "prepare" not in {line.what for line in lines_of(log)}


def test_bad_input_is_told_in_its_turn_and_as_without_workers(tmp_path: Path, log: Path) -> None:
    told = []
    for workers in (1, 2):
        _, others = both(log)
        bad = Timed(log=str(log), number=1, bad=True, worth=LONG)
        store, done = kept_in(tmp_path / str(workers)), list[str]()
        with pytest.raises(InputError) as caught:
            execute(plan_of(bad, *others), store, where=Placement(workers),
                    done=lambda name, _, done=done: done.append(name))  # fmt: skip
        told.append(str(caught.value))
        assert sorted(done) == sorted(task.key for task in others)
        assert all(store.get(task.key, task) for task in others)
    assert told[0] == told[1] == "number=1: is bad"


def test_nothing_that_is_prepared_is_left_in_the_folder(tmp_path: Path, log: Path) -> None:
    alone, others = both(log)
    names = []
    for workers in (1, 2):
        folder = tmp_path / str(workers)
        execute(plan_of(*alone, *others), kept_in(folder), where=Placement(workers))
        names.append(sorted(path.name for path in (folder / "kept").iterdir()))
    assert names[0] == names[1]
    assert len(names[0]) == 5


def test_what_is_kept_is_not_prepared_again(tmp_path: Path, log: Path) -> None:
    alone, others = both(log)
    first = execute(plan_of(*alone), kept_in(tmp_path), where=Placement(2))
    log.unlink()
    again = execute(plan_of(*alone, *others), kept_in(tmp_path), where=Placement(2))
    assert prepared(again, *alone) == prepared(first, *alone) == ["of 1", "of 2"]
    assert {line.kind for line in lines_of(log)} == {"other"}


def test_what_a_lost_worker_was_preparing_another_prepares(tmp_path: Path, log: Path) -> None:
    alone, others = both(log, flag=str(tmp_path / "flag"))
    results = execute(plan_of(*alone, *others), Store(None), where=Placement(2))
    assert prepared(results, *alone) == ["of 1", "of 2"]
    assert (tmp_path / "flag").exists()


@pytest.mark.parametrize(
    ("costs", "workers"),
    [
        ((LONG, LONG), 2),
        ((LONG,), 2),  # with what is prepared beside it
        ((1, 1), 1),
        ((), 1),
    ],
)
def test_processes_are_started_where_the_others_are_worth_it(
    log: Path, costs: tuple[int, ...], workers: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int | None] = []

    def noting(where: Placement, *_: object) -> Any:
        asked.append(where.workers)
        return open_place(THIS_PROCESS)

    monkeypatch.setattr(execution, "open_place", noting)
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    others = [Other(log=str(log), number=k, worth=worth) for k, worth in enumerate(costs)]
    alone = Timed(log=str(log), number=9, worth=LONG)
    execute(plan_of(alone, *others), Store(None), where=LOCAL_DEFAULT)
    assert asked[0] == workers
