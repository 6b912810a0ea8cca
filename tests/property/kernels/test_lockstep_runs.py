"""Runs in lockstep are those one by one: bits, bounds, and where an orbit leaves its range."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.lanes import IN_LANES, PATHS, path
from verify import arithmetic, code_cache, lockstep
from verify.arithmetic.compiled import engine, paths
from verify.arithmetic.lanes import vectors
from verify.arithmetic.lanes.vectors import LANES
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun, RunOutcome

OBSERVABLES = frozenset({"lambda", "mse", "delta_j_max", "extremes"})
H = {
    "duffing": ("p**2/2 + q**2/2 + delta*q**4/4", {"delta": Fraction(1)}),
    "pendulum": ("p**2/2 - cos(q)", {}),
    "well": ("p**2/2 + exp(q) - q + sqrt(2 + q**2)/(1 + q**2)", {}),
    "escapes": ("p**2/2 - q**4/4", {}),
    "driven": ("p**2/2 - (1 + cos(2*t)/2)*cos(q)", {}),
}


def runs(
    name: str, points: int = 0, scheme: str = "lie2", observables: frozenset[str] = OBSERVABLES
) -> list[KernelRun]:
    """Eleven, of which no two are alike: the last ones have other steps."""
    text, values = H[name]
    hamiltonian = Hamiltonian.parse(text, values)
    found = []
    for k in range(11):
        start = {"q": Fraction(k - 4, 7), "p": Fraction(3 - k, 11), "h": Fraction(1, 50 + k // 6)}
        start |= {"t": Fraction(k, 3)} if name == "driven" else {}
        steps = 300 + k // 4
        found.append(KernelRun(hamiltonian, scheme, start, steps, observables, points))
    return found


def done(
    all_runs: Sequence[KernelRun], digits: int, *, in_lockstep: bool, tangent: bool = True
) -> list[RunOutcome]:
    own = arithmetic.get("fixed", digits)
    courses = [run.run_in_turn(own, tangent=tangent) for run in all_runs]
    if not in_lockstep:
        return [lockstep.run_alone(course) for course in courses]
    ended = dict(lockstep.run_together(iter(courses), len(courses)))
    return [ended[k].result() for k in range(len(courses))]


def told(outcome: RunOutcome) -> Any:
    """All but times, and what is made anew for each path."""
    own = replace(outcome, seconds=0.0, kernel=None, state=tuple(outcome.state))
    return own, [dict(x) for x in own.trail], [dict(x) for x in own.tangents]


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("way", PATHS)
@pytest.mark.parametrize("name", H)
def test_runs_in_lockstep_have_the_bits_of_runs_one_by_one(name: str, way: str) -> None:
    """An orbit that leaves its range does so at the same step, and hurts no other."""
    with path(paths.OFF):
        alone = [told(x) for x in done(runs(name), 33, in_lockstep=False)]
    with path(way):
        assert [told(x) for x in done(runs(name), 33, in_lockstep=True)] == alone
    if name == "escapes":
        assert len({x[0].done for x in alone}) > 3


@pytest.mark.left_to_ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("digits", [40, 53, 72])
@pytest.mark.parametrize("scheme", ["lie2", "rk4", "stormer-verlet"])
def test_wider_numbers_and_other_schemes_too(scheme: str, digits: int) -> None:
    few = runs("pendulum", scheme=scheme, observables=frozenset({"lambda"}))[:4]
    alone = [told(x) for x in done(few, digits, in_lockstep=False, tangent=False)]
    with path(IN_LANES[0]):
        found = done(few, digits, in_lockstep=True, tangent=False)
    assert [told(x) for x in found] == alone


@pytest.mark.left_to_ci
def test_a_series_is_the_same() -> None:
    """Its kernel begins anew at every note, and is not called for a part of the way."""
    alone = [told(x) for x in done(runs("duffing", points=7), 33, in_lockstep=False)]
    with path(IN_LANES[0]):
        assert [told(x) for x in done(runs("duffing", points=7), 33, in_lockstep=True)] == alone
    assert all(len(x[0].series) == 7 for x in alone)


@pytest.fixture
def seen(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many lanes were used, call by call."""
    seen: list[int] = []
    true = engine.step_together

    def noting(orbits: Any, kernel: Any, lanes: int) -> None:
        seen.append(lanes)
        true(orbits, kernel, lanes)

    monkeypatch.setattr(engine, "step_together", noting)
    return seen


LOOPS = {
    "any part": "        x = x\n",
    "none": "        if k == 0: x = x + x\n",
}


@pytest.mark.parametrize("called_for", LOOPS)
def test_who_waits_longest_goes_on_with_those_that_have_the_longest_way(
    monkeypatch: pytest.MonkeyPatch, called_for: str
) -> None:
    """Where a kernel is called for no part of the way, with those that have the same."""
    stepped: list[list[int]] = []
    true = engine.step_together

    def noting(orbits: Any, kernel: Any, lanes: int) -> None:
        stepped.append([orbit.walk.every for orbit in orbits])
        true(orbits, kernel, lanes)

    monkeypatch.setattr(engine, "step_together", noting)
    loop = f"    for k in range(steps):\n{LOOPS[called_for]}    return steps, x\n"
    kernel = engine.compile_source("def f(steps: 'int', x: 'wide'):\n" + loop, 112, {})
    state = (engine.Fixed(1, 112),)
    ways = [engine.Walk(5 + k % 2, 3, (), state, later_steps=10 * k) for k in range(2 * LANES + 2)]
    pending = [lockstep.Pending(kernel, way) for way in ways]
    waiting = pending
    with path(IN_LANES[0]):
        while waiting:
            kernel.advance(waiting)
            waiting = [each for each in waiting if not each.finished]
    first = [0, *range(2 * LANES + 1, LANES + 2, -1)]
    if called_for == "none":
        first = [0, *range(2 * LANES, 2, -2)]
        assert all(len(set(each)) == 1 for each in stepped)
    assert stepped[0] == [5 + k % 2 for k in first]
    found = [each.result[-1][0].raw for each in pending]
    assert found == [1 if called_for == "any part" else 2**3] * len(ways)


@pytest.mark.left_to_ci
def test_lanes_are_used_where_there_is_more_than_one_orbit(seen: list[int]) -> None:
    with path(IN_LANES[0]):
        done(runs("duffing"), 33, in_lockstep=True)
        assert LANES in seen
        seen.clear()
        done(runs("duffing")[:1], 33, in_lockstep=True)
        assert set(seen) == {1}
    seen.clear()
    with path(paths.OFF):
        done(runs("duffing"), 33, in_lockstep=True)
    assert set(seen) == {1}


def test_lanes_are_compiled_for_long_work_only(
    seen: list[int], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Or where that was done before: what is kept is used at once."""
    monkeypatch.setenv(code_cache.VARIABLE, str(tmp_path / "kernels"))
    monkeypatch.setattr(paths, "forced_path", lambda: False)
    few = runs("duffing")
    steps = sum(run.steps for run in few)
    monkeypatch.setattr(engine, "_MIN_STEPS_TO_COMPILE", 3 * steps // 2)
    with path(IN_LANES[0]):
        done(few, 33, in_lockstep=True)
        assert set(seen) == {1}
        seen.clear()
        done(few, 33, in_lockstep=True)
        assert seen[0] == LANES
    seen.clear()
    with path(IN_LANES[0]):
        done(few, 33, in_lockstep=True)
    assert seen[0] == LANES


def test_a_lane_that_takes_its_neighbours_place_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    alone = [told(x) for x in done(runs("duffing"), 33, in_lockstep=False)]
    true = engine.Orbit.take

    def swapped(self: Any, result: Any, steps: int) -> None:
        result = result.copy()
        result[1] ^= 1  # the lowest bit of p
        true(self, result, steps)

    monkeypatch.setattr(engine.Orbit, "take", swapped)
    with path(IN_LANES[0]):
        assert [told(x) for x in done(runs("duffing"), 33, in_lockstep=True)] != alone


def test_an_unknown_way_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(paths.VARIABLE, "avx1024")
    with pytest.raises(InputError, match=r"VERIFY_LANES.*avx512, avx2, portable, off"):
        paths.choose_path()
    monkeypatch.setattr(vectors, "features", dict)
    monkeypatch.setenv(paths.VARIABLE, "avx512")
    with pytest.raises(InputError, match="no such instructions"):
        paths.choose_path()
    monkeypatch.delenv(paths.VARIABLE)
    assert paths.choose_path() is None
