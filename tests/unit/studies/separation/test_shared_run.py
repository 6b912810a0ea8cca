"""A grid's run that is its separation's first link too is done once, and is what it is alone."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.plans import kept_in, plain
from tests.helpers.constructed.scenes import HEAD, load
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS, Placement
from verify.execution.keeper import NOTHING
from verify.execution.plan import Plan, keys_supplied_by
from verify.kernels.stepping import KernelRun
from verify.lockstep import Course
from verify.runs.digits_on_demand import Measurement
from verify.runs.requested_run import RequestedRun
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.results.run import RunResult
from verify.scenes.results.separation import SeparationResult
from verify.studies.kinds.grid import serves_first_link
from verify.studies.kinds.separation import SeparationTask
from verify.studies.tasks_of_scenes import plan_scenes

STEPS = 300


def planned(
    folder: Path, digits: int = 30, arithmetic: str = "auto", q: str = "1.5", more: str = ""
) -> Plan:
    scene = HEAD + (
        f"[grid]\nsteps = {STEPS}\nstep_sizes = [0.1, 0.05]\n"
        f"initial_values = [{{ q = {q}, p = 0 }}]\n"
        f'arithmetic = "{arithmetic}"\ndigits = {digits}\nseparate = true\n{more}'
    )
    return plan_scenes([load(folder, scene)])


def of_kind(plan: Plan, kind: type[Any]) -> dict[str, Any]:
    return {name: task for name, task in plan.tasks.items() if isinstance(task, kind)}


@pytest.fixture
def stepped(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Fraction, int]]:
    """The step size and the number of notes of each run in exact arithmetic's stead."""
    seen: list[tuple[Fraction, int]] = []
    whole = KernelRun.run_in_turn

    def noting(self: KernelRun, *given: Any, **named: Any) -> Any:
        seen.append((self.start["h"], self.sections))
        return whole(self, *given, **named)

    monkeypatch.setattr(KernelRun, "run_in_turn", noting)
    return seen


def test_both_have_one_run_in_exact_arithmetic(
    tmp_path: Path, stepped: list[tuple[Fraction, int]]
) -> None:
    plan = planned(tmp_path)
    runs, separations = of_kind(plan, RunTask), of_kind(plan, SeparationTask)
    assert len(runs) == len(separations) == 2
    assert keys_supplied_by(plan.tasks.values()) == set(runs)
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
        ("auto", 20, True), ("fixed", 30, True), ("mpfr", 30, True),
        ("auto", 19, False), ("ball", 30, False), ("float64", 17, False),
    ],
)  # fmt: skip
def test_runs_that_do_not_do_for_a_first_link_are_done_by_themselves(
    tmp_path: Path, arithmetic: str, digits: int, shared: bool
) -> None:
    plan = planned(tmp_path, digits, arithmetic)
    assert (
        bool(keys_supplied_by(plan.tasks.values()))
        is shared
        is serves_first_link(arithmetic, digits)
    )
    assert all((task.run is not None) is shared for task in of_kind(plan, SeparationTask).values())


@pytest.mark.parametrize("observables", [[], ["mse"], ["lambda_max", "lambda_plain"]])
def test_a_run_without_lambda_is_no_first_link(tmp_path: Path, observables: list[str]) -> None:
    plan = planned(tmp_path, more=f"observables = {observables}\n")
    assert not keys_supplied_by(plan.tasks.values())
    found = execute(plan, Store(None), where=THIS_PROCESS)
    assert set(found) == set(plan.tasks)


def test_what_else_a_separation_runs_is_in_the_arithmetic_that_it_takes_alone(
    tmp_path: Path,
) -> None:
    plan = planned(tmp_path, arithmetic="mpmath")
    found = execute(plan, Store(None), where=THIS_PROCESS)
    for name, task in of_kind(plan, SeparationTask).items():
        alone = task.model_copy(update={"run": None}).compute(NOTHING)
        own, run = found[name], found[task.run.key]
        assert isinstance(own, SeparationResult)
        assert isinstance(run, RunResult)
        assert (own.arithmetic, run.arithmetic) == (alone.arithmetic, "mpmath")
        assert own.arithmetic != "mpmath"
        assert own.plain is not None
        assert alone.plain is not None
        pairs = zip(dict(own.plain.parts).values(), dict(alone.plain.parts).values(), strict=True)
        for one, other in pairs:
            apart = abs(Fraction(one.value) - Fraction(other.value))
            assert apart <= Fraction(one.bound) + Fraction(other.bound)


def test_a_shared_run_that_finds_no_digit_leaves_the_separation_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = planned(tmp_path)
    expected = plain(execute(plan, Store(None), where=THIS_PROCESS))
    whole = RequestedRun.take_measurement

    def unknown(self: RequestedRun, *given: Any) -> Course[Measurement]:
        found = yield from whole(self, *given)
        return replace(found, bounds=replace(found.bounds, values={}, status="unresolved"))

    monkeypatch.setattr(RequestedRun, "take_measurement", unknown)
    found = execute(plan, Store(None), where=THIS_PROCESS)
    separations = of_kind(plan, SeparationTask)
    assert {n: x for n, x in plain(found).items() if n in separations} == {
        n: expected[n] for n in separations
    }
    for task in separations.values():
        assert found[task.run.key].status == "unresolved"  # type: ignore[attr-defined]


def test_a_separation_that_ends_before_the_run_is_kept_where_that_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, store = planned(tmp_path, q="1e30", digits=40), kept_in(tmp_path)

    def interrupted(*_: Any) -> RunResult:
        raise KeyboardInterrupt

    monkeypatch.setattr(RunTask, "compute_in_turn", interrupted)
    with pytest.raises(KeyboardInterrupt):
        execute(plan, store, where=THIS_PROCESS)
    kept = {name for name, task in plan.tasks.items() if store.get(name, task)}
    assert kept >= set(of_kind(plan, SeparationTask))
    assert not kept & set(of_kind(plan, RunTask))


def test_a_cost_is_that_of_the_runs_arithmetic(tmp_path: Path) -> None:
    dear, cheap = (
        next(iter(of_kind(planned(tmp_path, arithmetic=name), SeparationTask).values())).cost
        for name in ("mpmath", "fixed")
    )
    assert dear > cheap


def test_the_time_of_a_plan_counts_a_shared_run_once(tmp_path: Path) -> None:
    shared, alone = planned(tmp_path), planned(tmp_path)
    for name, task in of_kind(alone, SeparationTask).items():
        alone.tasks[name] = task.model_copy(update={"run": None})
    assert shared.seconds < alone.seconds
