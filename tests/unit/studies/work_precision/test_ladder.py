"""The errors may be found by a worker: the result is the same, and only what is timed is left."""

import pickle
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.plans import kept_in
from tests.helpers.constructed.scenes import DUFFING, GRID, load
from tests.helpers.constructed.work import work_task
from verify.arithmetic.compiled.translation import Source
from verify.errors import InputError
from verify.execution.execute import Store, compute_task, execute
from verify.execution.executors import THIS_PROCESS, Placement
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.studies.kinds.work_precision import WorkPrecisionTask
from verify.studies.tasks_of_scenes import plan_scenes
from verify.studies.work_precision import ladder as finding
from verify.studies.work_precision.ladder import SchemeLadder

CASES: dict[str, dict[str, Any]] = {
    "two schemes": {},
    "time is no whole number of steps": {"step_sizes": ("0.3", "0.15")},
    "failed": {
        "hamiltonian": "p**2/2 + q**4/4", "q": 3, "time": 40, "schemes": ("lie1",),
        "step_sizes": (1, "0.001"), "number_systems_step_size": 1,
    },
    "in time": {"hamiltonian": "p**2/2 + q**2/2 - q*cos(t)", "t0": 2},
    "in degrees": {
        "hamiltonian": "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2", "q": (0, "0.1"),
        "p": ("0.4", 0),
    },
}  # fmt: skip
TIMES = {"seconds", "seconds_min", "seconds_median", "compile_seconds", "overhead", "comparisons"}


def untimed(data: Any) -> Any:
    """What was found, without times and what is made of them."""
    if isinstance(data, dict):
        return {key: untimed(value) for key, value in data.items() if key not in TIMES}
    return [untimed(each) for each in data] if isinstance(data, list | tuple) else data


def with_prepared(task: WorkPrecisionTask, prepared: object) -> WorkPrecisionResult:
    keeper = Keeper(None, "")
    keeper.prepared = prepared
    found = compute_task(task, keeper)
    assert isinstance(found, WorkPrecisionResult)
    return found


def never(monkeypatch: pytest.MonkeyPatch) -> None:
    """From now on this process finds no errors."""

    def refuse(*_: object) -> None:
        raise AssertionError("an error is found again")

    monkeypatch.setattr(SchemeLadder, "point", refuse)
    monkeypatch.setattr(finding, "reference", refuse)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_the_result_is_the_same_where_another_process_has_found_the_errors(
    changes: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    task = work_task(**changes)
    alone = compute_task(task)
    sent = pickle.loads(pickle.dumps(task.prepare()))  # noqa: S301 - our own
    never(monkeypatch)
    result = with_prepared(task, sent)
    assert untimed(result.model_dump()) == untimed(alone.model_dump())
    points = [point for line in result.lines for point in line.points]
    assert any(point.limited_by != "failed" for point in points)
    assert (changes is CASES["failed"]) is any(point.limited_by == "failed" for point in points)


def test_each_point_is_that_of_its_scheme_and_step_size_and_of_nothing_else() -> None:
    task = work_task()
    found = task.prepare()
    assert len(found.points) == 8
    for at, point in found.points.items():
        assert (point.scheme, Fraction(point.step_size or 0)) == at
    marked = {
        at: point.model_copy(update={"reason": f"{at[0]} {at[1]}"})
        for at, point in found.points.items()
    }
    lines = with_prepared(task, replace(found, points=marked)).lines
    assert [[point.reason for point in line.points] for line in lines] == [
        [f"{name} {h}" for h in task.step_sizes] for name in task.schemes
    ]


def test_it_is_compiling_that_is_timed_and_not_loading_what_is_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    task = work_task()
    found, right, asked = task.prepare(), Source.compile, []

    def compiled(self: Source, *, anew: bool = False) -> Any:
        asked.append(anew)
        return right(self, anew=anew)

    monkeypatch.setattr(Source, "compile", compiled)
    with_prepared(task, found)
    assert asked == [True] * 3  # a first one that wakes the compiler, and two schemes'


def test_all_of_the_time_counts_and_each_point_is_told_once() -> None:
    task, told = work_task(), list[int]()
    found = task.prepare()
    assert found.seconds > 0
    assert with_prepared(task, replace(found, seconds=1000.0)).seconds > 1000
    task.measure(told.append)
    assert told == [1] * 8


# -- executed -------------------------------------------------------------------------------------

SECTION = (
    "[work_precision]\ntime = 1\nstep_sizes = [0.5, 0.25]\nrepeats = 1\npeers = false\n"
    "initial_value = { q = 1, p = 0 }\nnumber_systems = []\n"
)


def plan_of(folder: Path) -> Plan:
    """Two tasks of times, and others."""
    texts = [DUFFING + f"parameters = {{ delta = {k} }}\n" + SECTION for k in (1, 2)]
    return plan_scenes([load(folder, text + (GRID if k else "")) for k, text in enumerate(texts)])


@pytest.mark.left_to_ci
@pytest.mark.parametrize("store", [kept_in, lambda _: Store(None)], ids=["folder", "none"])
def test_workers_find_the_errors_and_leave_nothing_else_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, store: Callable[[Path], Store]
) -> None:
    plan = plan_of(tmp_path)
    here = execute(plan, Store(None), where=THIS_PROCESS)
    never(monkeypatch)  # not in the workers
    there = execute(plan, store(tmp_path), where=Placement(2))
    assert set(there) == set(here)
    for name, found in there.items():
        assert untimed(found.model_dump()) == untimed(here[name].model_dump())
    kept = store(tmp_path).folder
    assert kept is None or len(list(kept.iterdir())) == len(plan.tasks)


def test_an_orbit_that_does_not_reach_the_time_is_the_same_bad_input() -> None:
    size = Fraction(1, 2)
    plan, told = Plan(), []
    for k in (20, 30):
        plan.need(work_task(hamiltonian="p**2/2 - q**4", time=k, step_sizes=(size, size / 2),
                            number_systems_step_size=size), "asked")  # fmt: skip
    for workers in (1, 2):
        with pytest.raises(InputError, match=r"work_precision\.time=20") as caught:
            execute(plan, Store(None), where=Placement(workers))
        told.append(str(caught.value))
    assert told[0] == told[1]
