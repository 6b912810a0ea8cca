"""A closed form that is too large is left out, everywhere, and that is said."""

import json

import pytest
from click.testing import CliRunner

from verify.claims.verdicts import make_report
from verify.commands.main import cli
from verify.execution.execute import Store
from verify.execution.executors import THIS_PROCESS
from verify.pages.page import render
from verify.scenes.results.report import Report
from verify.scenes.scene import scene_from

LARGE = "p**2/(2*(1 + q**2))"
SCHEMES = ["rk4", "yoshida4", "stormer-verlet", "euler"]


def scene_report(hamiltonian: str, schemes: list[str]) -> Report:
    scene = {
        "name": "mine", "title": "Mine", "hamiltonian": hamiltonian, "schemes": schemes,
        "criteria": [1, 2, 3, 4], "grid": {
            "time": 1, "step_sizes": ["0.1", "0.05"], "initial_values": [{"q": "0.5", "p": "0.3"}],
        },
    }  # fmt: skip
    scenes = [scene_from(scene, "mine.toml")]
    return make_report("Mine", scenes, (), Store(None), command="verify report", where=THIS_PROCESS)


def test_the_command_says_that_it_is_left_out() -> None:
    asked = ["prove", "--hamiltonian", LARGE, "--scheme", "rk4"]
    text = CliRunner().invoke(cli, asked)
    assert text.exit_code == 0
    assert "left out" in text.output
    found = json.loads(CliRunner().invoke(cli, [*asked, "--json"]).output)
    assert (found["verdict"], found["order"], found["delta_j"]) == ("PROVED", 5, None)


def test_a_report_says_so_and_shows_the_leading_term() -> None:
    made = scene_report(LARGE, ["rk4"])
    (proof,) = made.scenes[0].proofs
    assert (proof.p_next, proof.jacobian, proof.delta_j) == (None, None, None)
    page = render(made)
    assert page.count("left out") >= 2
    assert "Order of ΔJ" in page


@pytest.mark.parametrize("hamiltonian", ["p**2/2 - cos(q)", "p**2/2 + q**4/4"])
def test_a_report_takes_the_schemes_of_parts(hamiltonian: str) -> None:
    made = scene_report(hamiltonian, SCHEMES)
    proofs = {proof.scheme: proof for proof in made.scenes[0].proofs}
    assert set(proofs) == set(SCHEMES)
    assert {p.verdict.value for p in proofs.values()} == {"PROVED"}
    assert proofs["rk4"].delta_j not in (None, "0")
    assert proofs["yoshida4"].delta_j == "0"
    assert "too large" not in render(scene_report(hamiltonian, ["stormer-verlet"]))
