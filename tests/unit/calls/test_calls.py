"""Each call from Python: what it gives, old forms of it, and what it says of planted errors."""

import json
import math
from fractions import Fraction
from typing import Any

import pytest

import verify
from tests.helpers.maps import by_formulas
from verify import Hamiltonian, Verdict
from verify.errors import InputError
from verify.scenes.results import report as results
from verify.scenes.results import run as values
from verify.schemes import get

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
START = {"q": "1.5", "p": 0, "step_size": "0.1", "steps": 20}


def test_proofs_by_name_are_those_of_step_maps() -> None:
    lie2 = get("lie2")
    old = verify.prove(lie2.step_map(DUFFING), lie2)
    for found in (verify.prove("duffing", "lie2", parameters={"delta": 1}),
                  verify.prove(DUFFING, lie2), verify.prove(lie2.step_map(DUFFING), "lie2"),
                  verify.prove(DUFFING, lie2.step_map(DUFFING))):  # fmt: skip
        assert (found.verdict, found.order, found.leading) == (old.verdict, 3, old.leading)
    assert verify.prove("duffing", "lie2").leading.free_symbols - old.leading.free_symbols


def test_a_wrong_map_is_refuted_however_it_is_given() -> None:
    wrong = "p_next = p - h*q; q_next = q + h*p"
    for scheme in (wrong, by_formulas(DUFFING, "p - h*q", "q + h*p")):
        assert verify.prove(DUFFING, scheme).verdict is Verdict.REFUTED
        assert verify.check(DUFFING, scheme).verdict is Verdict.REFUTED


def test_a_run_without_an_arithmetic_is_in_float64_and_with_digits_is_certified() -> None:
    assert verify.run(DUFFING, "lie2", **START).arithmetic == "float64"
    found = verify.run(DUFFING, "lie2", digits=30, **START)
    assert found.error_kind == "enclosed"
    assert len(found.values["q"].value) > 30


def test_time_is_as_many_whole_steps_as_fit() -> None:
    start = {name: START[name] for name in ("q", "p", "step_size")}
    found = verify.run(DUFFING, "lie2", time=1.25, **start)
    assert found.steps == 12
    assert found.orbit.texts("t")[-1] == "1.2"


def test_an_orbit_is_made_once_and_points_thin_it() -> None:
    found = verify.run(DUFFING, "lie2", points=4, **START)
    assert len(found.orbit) == 5 == len(found.series) + 1
    assert found.orbit is found.orbit
    assert len(verify.run(DUFFING, "lie2", **START).orbit) == 21
    again = verify.RunResult.model_validate_json(found.model_dump_json())
    assert again.orbit.rows[::5] == found.orbit.rows
    assert "orbit" not in found.model_dump()
    assert again == found.with_points(0)
    with pytest.raises(InputError, match="has its values alone"):
        values.RunResult.model_validate_json(found.model_dump_json()).orbit  # noqa: B018


def test_runs_of_a_report_that_is_read_have_orbits() -> None:
    found = verify.run(DUFFING, "lie2", **START)
    scene = {"name": "one", "title": "", "source": "", "time": None, "proofs": (), "criteria": (),
             **DUFFING.texts, "runs": [found.model_dump()], "series": ()}  # fmt: skip
    made = {"command": "", "versions": {}, "machine": "", "seconds": 0, "kept": 0, "computed": 1}
    whole = {"title": "", "claims": (), "scenes": [scene], "left_out": (), "provenance": made}
    report = verify.Report.model_validate_json(json.dumps(whole))
    assert report.scenes[0].runs[0].orbit.rows == found.orbit.rows
    assert report.model_dump_json() == results.Report.model_validate(whole).model_dump_json()


def test_progress_is_told_to_a_function_of_the_callers() -> None:
    told: list[int] = []
    verify.run(DUFFING, "lie2", progress=told.append, **START)
    assert told[-1] == 20


def test_a_separation_adds_up() -> None:
    parts = verify.separate("duffing", "lie2", parameters={"delta": 1}, **START).plain
    assert parts is not None
    whole = parts.parts
    assert abs(float(whole.truncation) + float(whole.total) - float(whole.lambda_working)) < 1e-15


def test_a_region_keeps_its_area_by_a_symplectic_scheme_alone() -> None:
    found = verify.flow(
        DUFFING, ["lie2", "stormer-verlet"], shape="square", centre=(1, "1/2"), scale=0.1,
        step_size=0.1, times=[1], exact=False,
    )  # fmt: skip
    change = {image.map: abs(float(image.area_change or "nan")) for image in found.images}
    assert change["lie2"] > 1e-4 > change["stormer-verlet"]
    assert found.centre == ("1", "0.5")


def test_stability_blames_the_scheme() -> None:
    judged = verify.stability(
        DUFFING, ["euler", "stormer-verlet"], q=1, p=0, step_size=[0.1, 0.05], time=50
    )
    kinds = {(run.scheme, run.step_size): run.kind for run in judged}
    assert len(kinds) == 4
    assert kinds["stormer-verlet", "0.1"] == "stable"
    assert kinds["euler", "0.1"] != "stable"


def test_errors_against_run_times_are_measured() -> None:
    found = verify.bench(
        "harmonic", "stormer-verlet", parameters={"omega": 1}, q=1, p=0, time=1,
        step_sizes=[0.1, 0.05], repeats=1,
    )  # fmt: skip
    coarse, fine = (point.error for point in found.lines[0].points)
    assert coarse is not None
    assert fine is not None
    assert 3.8 < float(coarse) / float(fine) < 4.2


def leapfrog(p: Any, q: Any, h: Any) -> Any:
    p = p - h / 2 * math.sin(q)
    q = q + h * p
    return p - h / 2 * math.sin(q), q


def test_a_step_function_is_held_to_what_is_claimed_of_it() -> None:
    found = verify.check("pendulum", leapfrog, order=2, area_preserving=True)
    assert found.verdict is Verdict.PROVED
    assert verify.check("pendulum", leapfrog, order=3).verdict is Verdict.REFUTED


def test_a_scheme_is_held_to_what_is_claimed_of_it_too() -> None:
    assert verify.check("pendulum", "lie2").verdict is Verdict.PROVED
    assert verify.check("pendulum", "lie2", order=2).verdict is Verdict.PROVED
    assert verify.check("pendulum", "lie2", order=3).verdict is Verdict.REFUTED
    assert verify.check("pendulum", "lie2", area_preserving=True).verdict is Verdict.REFUTED
    made = get("lie2").step_map(Hamiltonian.parse("p**2/2 - cos(q)"))
    assert verify.check(made.hamiltonian, made, order=2).verdict is Verdict.PROVED
    assert verify.check(made.hamiltonian, made, order=3).verdict is Verdict.REFUTED


def test_a_sweep_is_the_runs_that_one_would_write_out() -> None:
    found = verify.sweep(
        "duffing", ["lie2", "rk4"], parameters={"delta": [1, 0.5]}, q=[1, 1.5], p=0,
        step_size=[0.1, 0.05], time=1,
    )  # fmt: skip
    assert len(found) == 16
    assert found.axes["delta"] == ("1", "0.5")
    for row, run in zip(found.rows, found, strict=True):
        at = dict(zip(found.columns, row, strict=True))
        own = {name: at[name] for name in ("q", "p", "step_size")}
        alone = verify.run(
            "duffing", at["scheme"], parameters={"delta": at["delta"]}, time=1, **own
        )
        # By default a run shows the energy too.
        assert {**alone.values, **run.values} == alone.values
        assert alone.values.keys() - run.values.keys() == {"energy_error", "energy_error_max"}
        assert (at["lambda"], at["lambda_bound"]) == (
            alone.values["lambda"].value, alone.values["lambda"].bound)  # fmt: skip
    assert [Fraction(x) for x in found.axes["step_size"]] == [Fraction(1, 10), Fraction(1, 20)]


def test_a_run_of_a_sweep_that_leaves_its_range_is_a_row_all_the_same() -> None:
    found = verify.sweep("p**2/2 - q**4/4", "lie2", q=[0.1, 9], p=0, step_size=0.1, steps=30)
    good, bad = found.rows
    assert (good[-1], bad[-1]) == ("finished", "left range")
    assert bad[found.columns.index("lambda")] == ""
    values = found.column("lambda")
    assert values[0] == float(good[found.columns.index("lambda")])
    assert math.isnan(values[1])
    with pytest.raises(ValueError, match="could not convert"):
        found.column("scheme")


def test_what_is_shown_is_short() -> None:
    shown = [DUFFING, verify.systems.get("duffing"), get("lie2"), get("lie2").step_map(DUFFING),
             verify.prove(DUFFING, "lie2"), verify.run(DUFFING, "lie2", **START)]  # fmt: skip
    for each in shown:
        assert len(repr(each)) < 260
        assert "\n" not in repr(each)
        assert " at 0x" not in repr(each)
    assert repr(DUFFING) == "Hamiltonian(delta*q**4/4 + p**2/2 + q**2/2, delta = 1)"


def test_systems_and_maps_have_their_formulas_in_latex() -> None:
    assert DUFFING._repr_latex_() == (
        r"$$\begin{aligned} H &= \frac{\delta q^{4}}{4} + \frac{p^{2}}{2} + \frac{q^{2}}{2} \\ "
        r"\delta &= 1 \end{aligned}$$"
    )
    assert r"- \cos" in verify.systems.get("pendulum")._repr_latex_()
    latex = get("symplectic-euler").step_map(DUFFING)._repr_latex_()
    assert "p' &= " in latex
    assert "q' &= " in latex
    assert "not written" in get("gauss4").step_map(DUFFING)._repr_latex_()
