"""A grid's run that is its separation's first link too is done once, and is what it is alone."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.plans import kept_in, plain
from tests.helpers.constructed.scenes import HEAD, load
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS, Placement
from verify.execution.keeping import NOTHING
from verify.execution.plan import Plan
from verify.kernels.stepping import KernelRun
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationResult
from verify.studies.plan import plan_scenes
from verify.studies.separation.task import SeparationTask, does_for_first_link

STEPS = 300


def planned(folder: Path, digits: int = 30, arithmetic: str = "auto", q: str = "1.5") -> Plan:
    scene = HEAD + (
        f"[grid]\nsteps = {STEPS}\nstep_sizes = [0.1, 0.05]\n"
        f"initial_values = [{{ q = {q}, p = 0 }}]\n"
        f'arithmetic = "{arithmetic}"\ndigits = {digits}\nseparate = true\n'
    )
    return plan_scenes([load(folder, scene)])


def of_kind(plan: Plan, kind: type[Any]) -> dict[str, Any]:
    return {name: task for name, task in plan.tasks.items() if isinstance(task, kind)}


@pytest.fixture
def stepped(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Fraction, int]]:
    """The step size and the number of notes of each run in exact arithmetic's stead."""
    seen: list[tuple[Fraction, int]] = []
    whole = KernelRun.run

    def noting(self: KernelRun, *given: Any, **named: Any) -> Any:
        seen.append((self.start["h"], self.sections))
        return whole(self, *given, **named)

    monkeypatch.setattr(KernelRun, "run", noting)
    return seen


def test_both_have_one_run_in_exact_arithmetic(
    tmp_path: Path, stepped: list[tuple[Fraction, int]]
) -> None:
    plan = planned(tmp_path)
    runs, separations = of_kind(plan, RunTask), of_kind(plan, SeparationTask)
    assert len(runs) == len(separations) == 2
    assert plan.given == set(runs)
    results = execute(plan, Store(None), where=THIS_PROCESS)
    assert set(results) == set(plan.tasks)
    exact = {Fraction(1, 10), Fraction(1, 20)}
    assert sorted(h for h, _ in stepped if h in exact) == sorted(exact)
    assert len(stepped) == 4  # and one each at the inputs as float64 has them


def test_each_is_what_it_is_alone(tmp_path: Path) -> None:
    plan = planned(tmp_path)
    together = execute(plan, Store(None), where=THIS_PROCESS)
    apart: dict[str, Frozen] = {n: task.compute(NOTHING) for n, task in plan.tasks.items()}
    assert plain(together) == plain(apart)
    for name, task in of_kind(plan, SeparationTask).items():
        own, run = together[name], together[task.run.key]
        assert isinstance(own, SeparationResult)
        assert isinstance(run, RunResult)
        assert own.plain is not None
        truncation, whole = own.plain.parts.truncation, run.values["lambda"]
        apart_by = abs(Fraction(truncation.value) - Fraction(whole.value))
        assert apart_by <= Fraction(truncation.bound) + Fraction(whole.bound)


def test_in_workers_it_is_the_same(tmp_path: Path) -> None:
    plan = planned(tmp_path)
    here = execute(plan, Store(None), where=THIS_PROCESS)
    assert plain(execute(plan, Store(None), where=Placement(workers=2))) == plain(here)


@pytest.mark.parametrize("kind", [RunTask, SeparationTask])
def test_what_is_kept_of_the_two_is_not_told_twice_and_the_other_is_done(
    tmp_path: Path, kind: type[Any]
) -> None:
    plan = planned(tmp_path)
    whole = execute(plan, Store(None), where=THIS_PROCESS)
    store = kept_in(tmp_path)
    for name in of_kind(plan, kind):
        store.put(name, whole[name])
    told: list[str] = []
    found = execute(plan, store, where=THIS_PROCESS, done=lambda name, _: told.append(name))
    assert plain(found) == plain(whole)
    assert sorted(told) == sorted(plan.tasks)


def test_where_float64_leaves_its_range_the_run_is_done_all_the_same(tmp_path: Path) -> None:
    plan = planned(tmp_path, q="1e30", digits=40)
    found = execute(plan, Store(None), where=THIS_PROCESS)
    for name, task in of_kind(plan, SeparationTask).items():
        own = found[name]
        assert isinstance(own, SeparationResult)
        assert own.status == "left range"
        assert plain({"": found[task.run.key]}) == plain({"": task.run.compute(NOTHING)})


@pytest.mark.parametrize(
    ("arithmetic", "digits", "shared"),
    [
        ("auto", 26, True), ("fixed", 30, True), ("mpfr", 30, True),
        ("auto", 25, False), ("ball", 30, False), ("float64", 17, False),
    ],
)  # fmt: skip
def test_runs_that_do_not_do_for_a_first_link_are_done_by_themselves(
    tmp_path: Path, arithmetic: str, digits: int, shared: bool
) -> None:
    plan = planned(tmp_path, digits, arithmetic)
    assert bool(plan.given) is shared is does_for_first_link(arithmetic, digits)
    assert all((task.run is not None) is shared for task in of_kind(plan, SeparationTask).values())


def test_the_time_of_a_plan_counts_a_shared_run_once(tmp_path: Path) -> None:
    shared, alone = planned(tmp_path), planned(tmp_path)
    for name, task in of_kind(alone, SeparationTask).items():
        alone.tasks[name] = task.model_copy(update={"run": None})
    assert shared.seconds < alone.seconds
