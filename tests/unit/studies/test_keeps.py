"""What a step keeps, as a task of a scene: the plan, the proofs, and runs with their energy."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.constructed.scenes import GRID, SERIES, load
from verify.claims.verdicts import make_report
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.runs.task import RunTask
from verify.scenes.results.kept import KeptResult
from verify.scenes.results.report import Report, SceneResult
from verify.studies.kinds.keeps import KeepsTask
from verify.studies.tasks_of_scenes import plan_scenes

PREY = """
field = "u_dot = u*(v - 2); v_dot = v*(1 - u)"
schemes = ["rk4", "u_next = u*exp(h*(v - 2)); v_next = v*exp(h*(1 - u*exp(h*(v - 2))))"]
[keeps]
structures = ["2*log(v) - v + log(u) - u: 3"]
form = "du^dv/(u*v)"
"""
PENDULUM = 'system = "pendulum"\nschemes = ["lie2", "stormer-verlet"]\n'
ENERGY = PENDULUM + 'keeps = ["energy: 3", "area"]\n'


def result_of(folder: Path, content: str) -> SceneResult:
    scene = load(folder, content)
    made = make_report("x", [scene], (), Store(None), command="x", where=THIS_PROCESS)
    (result,) = Report.model_validate_json(made.model_dump_json()).scenes
    assert result == made.scenes[0]
    return result


def table(results: tuple[KeptResult, ...]) -> list[tuple[object, ...]]:
    return [
        (result.verdict, [(x.structure, x.verdict, x.exact, x.order) for x in result.keeps])
        for result in results
    ]


def test_each_scheme_of_equations_is_proved_to_keep_what_it_keeps(tmp_path: Path) -> None:
    result = result_of(tmp_path, PREY)
    integral = "2*log(v) - v + log(u) - u"
    assert table(result.keeps) == [
        ("REFUTED", [(integral, "PROVED", False, 5), ("symplectic", "REFUTED", False, 5)]),
        ("REFUTED", [(integral, "REFUTED", False, 2), ("symplectic", "PROVED", True, None)]),
    ]
    assert result.hamiltonian == "u_dot = u*(v - 2); v_dot = v*(1 - u)"
    assert (result.proofs, result.runs, result.series) == ((), (), ())


def test_of_equations_volume_is_looked_at_where_nothing_is_named(tmp_path: Path) -> None:
    shear = 'field = "x_dot = y**2; y_dot = z; z_dot = 0"\nschemes = ["rk4", "lie2"]\n'
    kept = result_of(tmp_path, shear).keeps
    assert table(kept) == [("PROVED", [("volume", "PROVED", True, None)])] * 2
    rotation = shear.replace("y**2", "y").replace("z;", "-x;")
    assert [x.verdict for x in result_of(tmp_path, rotation).keeps] == ["REFUTED"] * 2


def test_of_equations_nothing_is_looked_at_that_their_flow_does_not_keep(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, PREY.partition("[keeps]")[0])])
    assert (plan.tasks, plan.left_out[-1][1]) == ({}, "the scene has no `keeps`")


def test_of_many_equations_volume_is_not_looked_at_by_default(tmp_path: Path) -> None:
    rows = "; ".join(f"x{k}_dot = x{(k + 1) % 13}" for k in range(13))
    field = f'field = "{rows}"\nschemes = ["rk4"]\n'
    assert not plan_scenes([load(tmp_path, field)]).tasks


def test_a_plan_of_equations_has_nothing_else(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, PREY)])
    assert {type(task) for task in plan.tasks.values()} == {KeepsTask}
    assert len(plan.tasks) == 2
    assert {why for _, why in plan.left_out} == {
        "the scene has no [grid]", "the scene has no [[series]]"
    }  # fmt: skip


def test_without_keeps_nothing_is_proved_of_it_and_the_plan_says_so(tmp_path: Path) -> None:
    plan = plan_scenes([load(tmp_path, PENDULUM)])
    assert not any(isinstance(task, KeepsTask) for task in plan.tasks.values())
    assert "the scene has no `keeps`" in dict(plan.left_out).values()


def runs(folder: Path, content: str) -> dict[str, set[str]]:
    plan = plan_scenes([load(folder, content + GRID + SERIES)])
    tasks = [task for task in plan.tasks.values() if isinstance(task, RunTask)]
    return {f"{x.scheme} {x.points}": set(x.observables or ()) for x in tasks}


def test_runs_have_their_energy_only_where_it_is_asked_for(tmp_path: Path) -> None:
    asked = runs(tmp_path, ENERGY)
    assert set(asked) == {f"{x} {n}" for x in ("lie2", "stormer-verlet") for n in (0, 600)}
    assert all("energy_error_max" in names for names in asked.values())
    plain = runs(tmp_path, PENDULUM + 'keeps = ["area"]\n')
    assert set(plain) == {"lie2 0", "lie2 600"}
    assert not any("energy_error_max" in names for names in plain.values())


def test_a_series_has_the_energy_of_its_own_numbers(tmp_path: Path) -> None:
    content = ENERGY.replace('system = "pendulum"', 'hamiltonian = "(p**2 + q**2)/2"') + SERIES
    _, verlet = result_of(tmp_path, content).series
    assert [x.last for x in verlet.series] == list(range(1, 11))
    # By hand: H = p²/2 + q²/2 from q = 1.5, p = 0 with h = 1/10.
    p, q, h = Fraction(0), Fraction(3, 2), Fraction(1, 10)
    for point in verlet.series:
        p -= h / 2 * q
        q += h * p
        p -= h / 2 * q
        energy = (p**2 + q**2) / 2 - Fraction(9, 8)
        assert point.energy is not None
        assert float(point.energy) == pytest.approx(float(energy), rel=1e-6, abs=1e-15)
        assert (point.delta_j, point.lam) == (("0", "0"), ("0", "0"))
    largest = max(abs(float(x.energy or 0)) for x in verlet.series)
    assert float(verlet.values["energy_error_max"].value) == pytest.approx(largest, rel=1e-6)


def test_runs_of_a_scene_accumulate_what_has_a_density_or_a_bracket(tmp_path: Path) -> None:
    """On the circle RK4 keeps all that is a function of the radius times a form, as it commutes
    with rotations; symplectic Euler does not."""
    scene = """
    hamiltonian = "p**2/2 + q**2/2"
    schemes = ["rk4", "symplectic-euler"]
    [keeps]
    structures = ["symmetric"]
    density = "1/(p**2 + q**2)"
    poisson = "0, p**2 + q**2; -p**2 - q**2, 0"
    """
    result = result_of(tmp_path, scene + GRID)
    names = {x.structure: x.observable for x in result.keeps[0].keeps}
    assert names["symmetric"] == ""
    kept, lost = result.runs
    for name in (names["volume"], names["poisson"]):
        assert name.startswith("accumulated_defect: ")
        assert (kept.values[name].value, name in kept.exact) == ("0", True)
        assert abs(lost.values[name].exact) > Fraction(1, 100)
        assert lost.error_kind == "enclosed"


def test_the_observable_of_a_structure_is_one_of_the_scenes_runs(tmp_path: Path) -> None:
    henon = 'hamiltonian = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"\n'
    henon += 'schemes = ["lie2"]\nkeeps = ["energy: 3", "symplectic", "volume", "reversible"]\n'
    (kept,) = result_of(tmp_path, henon).keeps
    observables = {x.structure: x.observable for x in kept.keeps}
    assert observables == {
        "energy": "energy_error_max", "symplectic": "symplectic_defect", "volume": "lambda",
        "reversible": "",
    }  # fmt: skip
    (plain,) = result_of(tmp_path, PREY.replace('"rk4", ', "")).keeps
    changes = "integral_error_max: -u - v + log(u) + 2*log(v)"
    form = "accumulated_defect: form = (1/(u*v))*du^dv"
    assert [x.observable for x in plain.keeps] == [changes, form]
