"""Error against run time of an H that depends on time; the scenes that the manual shows."""

from fractions import Fraction
from functools import cache
from math import log2
from typing import Any

import pytest

from tests.helpers.constructed.work import work_task
from tests.paths import ROOT
from verify.execution.execute import compute_task
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.scenes.scene import Scene, load_scene
from verify.studies.work_precision.ladder import SchemeLadder
from verify.studies.work_precision.problem import ReferenceProblem, reference

DRIVEN = ROOT / "reports" / "driven"
SLOPES = {"stormer-verlet": 2, "forest-ruth": 4, "triple-jump6": 6, "gauss4": 4, "rk4": 4}
WRONG = (
    "stormer-verlet, clock frozen", "forest-ruth, clock exchanged", "blanes-moan4, clock frozen",
)  # fmt: skip


@cache
def scenes() -> dict[str, Scene]:
    """Those of the manual that ask for error against run time."""
    asking = (x for x in sorted(DRIVEN.glob("*.toml")) if "[work_precision" in x.read_text())
    files = {path.stem: load_scene(path) for path in asking}
    return {name: scene for name, scene in files.items() if scene.work_precision}


def problem(scene: Scene) -> ReferenceProblem:
    assert scene.work_precision is not None
    exact, time = scene.exact_hamiltonian(), Fraction(scene.work_precision.time)
    start = {"p": Fraction(0), "q": Fraction(1)}
    return ReferenceProblem(exact, start, time, scene.t0, reference(exact, start, time, scene.t0))


CASES = [("duffing", x) for x in (*SLOPES, *WRONG)]
CASES += [("mathieu", x) for x in ("stormer-verlet", "rk4", WRONG[0])]


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(("name", "scheme"), CASES)
def test_right_clocks_keep_the_order_and_wrong_ones_leave_1(name: str, scheme: str) -> None:
    ladder = SchemeLadder(problem(scenes()[name]), scheme)
    coarse, fine = (ladder.point(Fraction(1, n)) for n in (40, 80))
    assert coarse.error is not None
    assert fine.error is not None
    slope = log2(float(coarse.error.value) / float(fine.error.value))
    assert abs(slope - SLOPES.get(scheme, 1)) < 0.25


def test_there_are_two_scenes_of_thirteen_methods() -> None:
    assert sorted(scenes()) == ["duffing", "mathieu"]
    for scene in scenes().values():
        assert scene.exact_hamiltonian().time_dependent
        assert len(scene.schemes) == 13
        assert tuple(name for name in scene.schemes if ", clock" in name) == WRONG


def test_energy_is_none_and_t0_counts() -> None:
    asked = {"hamiltonian": "p**2/2 + q**2/2 - q*cos(t)", "schemes": ("stormer-verlet",)}
    sizes: dict[str, Any] = {"step_sizes": ("0.2", "0.1"), "number_systems_step_size": "0.1"}
    early, late = (compute_task(work_task(**asked, **sizes, t0=t)) for t in (0, 2))
    assert isinstance(early, WorkPrecisionResult)
    assert isinstance(late, WorkPrecisionResult)
    points = [point for found in (early, late) for line in found.lines for point in line.points]
    assert all(point.energy is None for point in points)
    errors = [point.error for point in points]
    assert errors[0] != errors[2]
    assert (early.t0, late.t0) == ("0", "2")
