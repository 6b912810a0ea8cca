"""`bench` and `stability` of H(p1 … pn, q1 … qn), in one line and from files."""

import json
from pathlib import Path

import pytest

from tests.end_to_end.test_one_line import here, json_of

HENON = ["--system", "henon-heiles", "--q", "0,0.1", "--p", "0.4,0"]


def test_bench_has_w_beside_errors(capsys: pytest.CaptureFixture[str]) -> None:
    sizes = ["--step-size", "0.1", "--step-size", "0.05", "--time", "1", "--repeats", "1"]
    schemes = ["--scheme", "lie2", "--scheme", "stormer-verlet"]
    status, out, _ = here(capsys, "bench", *HENON, *schemes, *sizes, "--json")
    assert status == 0
    found = json_of(out)
    assert found["scenes"][0]["q"] == ["0", "0.1"]
    defects = {x["scheme"]: x["symplectic_defect"] for x in found["points"] if x["step_size"]}
    assert float(defects["lie2"]) > 0
    assert float(defects["stormer-verlet"]) == 0
    status, shown, _ = here(capsys, "bench", *HENON, *schemes, *sizes)
    assert status == 0
    assert "max |W|" in shown


def test_a_chain_is_judged_with_its_own_number_of_masses(
    capsys: pytest.CaptureFixture[str],
) -> None:
    chain = ["--system", "fput", "--param", "n=4", "--param", "alpha=1/4", "--param", "beta=0"]
    start = ["--q", "1,0,0,0", "--p", "0,0,0,0", "--step-size", "0.1", "--time", "10"]
    status, shown, _ = here(capsys, "stability", *chain, *start, "--scheme", "stormer-verlet")
    assert (status, shown.split()[0]) == (0, "stable")


@pytest.mark.parametrize(
    ("command", "start", "said"),
    [
        ("stability", ["--q", "0", "--p", "0.4,0"], "--q=0: has 1 of 2 numbers"),
        ("bench", ["--q", "0,0.1", "--p", "0.4"], "--p=0.4: has 1 of 2 numbers"),
        ("stability", ["--q", "0,x", "--p", "0.4,0"], "--q=x"),
    ],
)
def test_mistakes_are_one_line(
    command: str, start: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    more = ["--scheme", "rk4", "--step-size", "0.1", "--time", "1"]
    more += ["--step-size", "0.05"] if command == "bench" else []
    status, out, err = here(capsys, command, "--system", "henon-heiles", *more, *start)
    assert (status, out) == (2, "")
    assert said in err
    assert err.count("\n") == 1


def test_what_is_of_the_plane_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'system = "henon-heiles"\nschemes = ["rk4"]\ncriteria = [1]\n[[largest_step]]\ntime = 1\n'
        "initial_value = { q = [0, 0.1], p = [0, 0] }\n"
    )
    status, _, err = here(capsys, "stability", str(file))
    assert status == 2
    assert "criteria takes p and q" in err


def test_linear_theory_at_an_equilibrium(capsys: pytest.CaptureFixture[str]) -> None:
    trap = ["--system", "magnetic", "--param", "b=3/2", "--param", "k=1", "--param", "c=1"]
    asked = ["stability", "--linear", "--scheme", "rk4", *trap, "--json"]
    status, shown, _ = here(capsys, *asked, "--step-size", "1.2", "--step-size", "1.5")
    found = json.loads(shown)
    assert status == 0
    assert [f["exact"] for f in found["frequencies"]] == ["1/2", "2"]
    assert [x["bounded"] for x in found["decided"]] == [True, False]
    assert found["step_size"] is None
    status, _, err = here(capsys, *asked)
    assert (status, err.count("\n")) == (2, 1)
    assert "--step-size: is needed" in err
    away = ["--system", "henon-heiles", "--q", "0,2", "--p", "0,0"]
    status, _, err = here(capsys, "stability", "--linear", "--scheme", "rk4", *away)
    assert (status, err.count("\n")) == (2, 1)
    assert "is no equilibrium: ∂H/∂q2 = -2 there, not 0" in err


def test_orbits_over_two_initial_values(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'system = "henon-heiles"\nschemes = ["rk4"]\n[[orbit_map]]\naxes = ["q2", "p2"]\n'
        "across = { from = 0, to = 1.2, count = 3 }\nupwards = [0.1]\ntime = 100\n"
        "initial_value = { q = [0, 0], p = [0.1, 0] }\nstep_size = 0.1\n"
    )
    status, shown, _ = here(capsys, "stability", str(file))
    assert (status, shown) == (0, "rk4: orbits over q2 and p2: 2 regular, 1 leaves\n")
