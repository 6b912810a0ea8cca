"""Cases that a fresh pair of eyes found wrong once: each held here, so that it stays right."""

from fractions import Fraction
from pathlib import Path

import pytest

from tests.helpers.maps import by_formulas
from verify.claims.verdicts import make_report
from verify.errors import InputError
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.runs.requested_run import run
from verify.scenes.scene import scene_from
from verify.studies.criteria_verdicts import judge
from verify.verdict import Verdict


def test_an_orbit_that_leaves_the_saddle_only_in_truth_is_given_no_wrong_digit() -> None:
    """float64 stays at π, the exact orbit of the float nearest to π does not."""
    pendulum = Hamiltonian.parse("p**2/2 - cos(q)")
    at = {"q": "3.1415926535897932", "p": 0, "step_size": "0.002", "steps": 25000}
    true = run(pendulum, "lie2", **at, arithmetic="mpfr", digits=12).values["p"]
    found = run(pendulum, "lie2", **at)
    if found.status == "finished":
        error = abs(Fraction(found.values["p"].value) - Fraction(true.value))
        assert error <= Fraction(found.values["p"].bound)
    else:
        assert (found.status, found.values) == ("unresolved", {})


def test_where_the_solution_blows_up_criteria_3_and_4_are_not_proved_for_the_scene() -> None:
    scene = scene_from(
        {
            "name": "blow-up", "hamiltonian": "p**2/2 - q**4", "schemes": ["lie2"],
            "criteria": [2, 3, 4],
            "grid": {"time": 100, "step_sizes": ["0.01", "0.02"],
                     "initial_values": [{"q": 1, "p": 0}]},
        },
        "test",
    )  # fmt: skip
    report = make_report("t", [scene], [], Store(None), command="test", where=THIS_PROCESS)
    (result,) = report.scenes
    assert all(r.status == "left range" for r in result.runs)
    verdicts = {c.number: c.verdict for c in result.criteria}
    assert verdicts == {2: Verdict.PROVED, 3: Verdict.UNDECIDED, 4: Verdict.UNDECIDED}
    assert judge(4, result.proofs[0], []).verdict is Verdict.PROVED


def test_a_defect_beyond_every_order_looked_at_is_still_a_defect() -> None:
    p_next, q_next = "p*cos(h) - q*sin(h) + sin(h)**15*p", "q*cos(h) + p*sin(h)"
    step_map = by_formulas(Hamiltonian.parse("(p**2 + q**2)/2"), p_next, q_next)
    proof = prove(step_map)
    assert (proof.area_preserving, proof.order) == (False, None)
    assert "is not the zero function" in proof.reason


GRID = {"time": 1, "step_sizes": ["0.1"], "initial_values": [{"q": 0, "p": 1}]}
TYPOS = {
    "key": ({"scheems": ["lie2"]}, "scheems"),
    "nested key": ({"grid": {**GRID, "initial_values": [{"q": 0, "r": 1}]}}, "initial_values.0.r"),
    "time": ({"grid": {**GRID, "time": "abc"}}, "time=abc"),
    "same step size": ({"grid": {**GRID, "step_sizes": ["0.1", "1/10"]}}, "twice"),
    "same start": ({"grid": {**GRID, "initial_values": [{"q": 0, "p": 1}] * 2}}, "twice"),
}


@pytest.mark.parametrize(("change", "named"), TYPOS.values(), ids=TYPOS)
def test_a_typing_mistake_is_named_as_it_was_typed(change: dict, named: str) -> None:
    scene = {"system": "pendulum", "schemes": ["lie2"]} | change
    if "scheems" in change:
        del scene["schemes"]
    with pytest.raises(InputError, match=named):
        scene_from(scene, "mine.toml")


def test_the_api_names_what_is_no_text() -> None:
    with pytest.raises(InputError, match="scheme=5"):
        run(Hamiltonian.parse("p*q"), 5, q=0, p=1, step_size=1, steps=1)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="not text"):
        Hamiltonian.parse(5)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="parameters"):
        Hamiltonian.parse("p+q", [1])  # type: ignore[arg-type]


def test_results_json_holds_no_float(tmp_path: Path) -> None:
    scene = scene_from({"name": "s", "system": "pendulum", "schemes": ["lie2"], "grid": GRID}, "t")
    report = make_report("t", [scene], [], Store(tmp_path), command="test", where=THIS_PROCESS)

    def floats(x: object) -> bool:
        if isinstance(x, dict):
            return any(map(floats, x.values()))
        return any(map(floats, x)) if isinstance(x, list) else isinstance(x, float)

    assert not floats(report.model_dump(mode="json"))
