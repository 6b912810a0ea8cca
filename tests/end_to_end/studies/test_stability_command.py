"""`verify stability`: its JSON keys, its text, a suite's small scenes, bad input."""

from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here, json_of
from tests.paths import ROOT
from verify.commands.shared.input import load_target

SCENE = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2", "stormer-verlet"]

[[stability]]
name = "small and large steps"
steps = 400
step_sizes = [0.1, 2]
initial_values = [{ q = 1, p = 0 }]

[[largest_step]]
time = 40
initial_value = { q = 1, p = 0 }

[[stability_map]]
parameter = "delta"
values = [1, 100]
step_sizes = [0.01, 1]
steps = 200
initial_value = { q = 1, p = 0 }
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(SCENE)
    return path


def test_each_case_has_its_id_verdict_and_detail(
    capsys: pytest.CaptureFixture[str], scene: Path
) -> None:
    status, out, err = here(capsys, "stability", str(scene), "--json")
    assert (status, err) == (0, "")
    found = json_of(out)
    verdicts = {case["id"]: case["verdict"] for case in found["cases"]}
    name = "mine/small and large steps"
    assert verdicts[f"{name}/stormer-verlet/h=0.1"] == "stable"
    assert verdicts[f"{name}/stormer-verlet/h=2"] == "unstable: scheme"
    assert verdicts[f"{name}/lie2/h=2"] == "unstable: scheme"
    assert all(case["detail"] for case in found["cases"])
    assert [step["scheme"] for step in found["largest_steps"]] == ["lie2", "stormer-verlet"]
    assert {over["scheme"] for over in found["maps"]} == {"lie2", "stormer-verlet"}


def test_the_text_names_case_verdict_and_reason(
    capsys: pytest.CaptureFixture[str], scene: Path
) -> None:
    status, out, _ = here(capsys, "stability", str(scene))
    assert status == 0
    assert "unstable: scheme" in out
    assert "the scheme leaves the bounds at step" in out
    assert "stormer-verlet: bounded up to h = " in out


def test_what_is_kept_is_not_done_again(
    capsys: pytest.CaptureFixture[str], scene: Path, tmp_path: Path
) -> None:
    keep = str(tmp_path / "kept")
    first = here(capsys, "stability", str(scene), "--json", "--keep", keep)
    again = here(capsys, "stability", str(scene), "--json", "--keep", keep)
    assert first == again
    assert list((tmp_path / "kept").glob("*.json"))


SMALL = ("free", "pushed", "zero", "quartic_sizes")


@pytest.mark.parametrize("name", SMALL)
def test_the_extreme_scenes_end_in_the_verdicts_that_are_right(
    capsys: pytest.CaptureFixture[str], name: str
) -> None:
    assert name in {scene.name for scene in load_target("extreme")[1]}
    path = ROOT / "reports" / "suites" / "extreme" / f"{name}.toml"
    status, out, err = here(capsys, "stability", str(path), "--json")
    assert (status, err) == (0, "")
    verdicts = {case["id"]: case["verdict"] for case in json_of(out)["cases"]}
    if name != "quartic_sizes":
        assert set(verdicts.values()) == {"stable"}
        return
    assert {v for n, v in verdicts.items() if "vanishes" in n} == {"underflow"}
    assert {v for n, v in verdicts.items() if "too large" in n} == {"overflow at step 1"}
    assert {v for n, v in verdicts.items() if "ordinary" in n} == {"unstable: scheme"}


RUN = ["--system", "henon-heiles", "--scheme", "rk4", "--step-size", "0.1", "--time", "1"]
LINEAR = ["--linear", "--scheme", "rk4"]
TRAP = ["--system", "magnetic", "--param", "b=3/2", "--param", "k=1", "--param", "c=1"]


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ([], "SCENE: is missing"),
        (["--scheme", "lie2"], "--system, --hamiltonian: give one of the two"),
        (["stiff", "--scheme", "lie2"], "--scheme=lie2: goes without SCENE"),
        (["stiff", "--linear", "--scheme", "lie2"], "does not go with --linear"),
        (["--linear"], "--scheme: give one with --linear"),
        (["nowhere.toml"], "No such file"),
        ([*RUN, "--q", "0", "--p", "0.4,0"], "--q=0: has 1 of 2 numbers"),
        ([*RUN, "--q", "0,x", "--p", "0.4,0"], "--q=x"),
        ([*LINEAR, *TRAP], "--step-size: is needed"),
        ([*LINEAR, "--system", "henon-heiles", "--q", "0,2", "--p", "0,0"],
         "is no equilibrium: ∂H/∂q2 = -2 there, not 0"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line(
    capsys: pytest.CaptureFixture[str], options: list[str], problem: str
) -> None:
    status, out, err = here(capsys, "stability", *options)
    assert (status, out) == (2, "")
    assert problem in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("scene", "problem"),
    [
        ('system = "harmonic"\nschemes = ["lie2"]\n', "asks for no [[stability]]"),
        ('system = "henon-heiles"\nschemes = ["rk4"]\ncriteria = [1]\n[[largest_step]]\n'
         "time = 1\ninitial_value = { q = [0, 0.1], p = [0, 0] }\n", "criteria takes p and q"),
    ],
    ids=["nothing of it", "of the plane alone"],
)  # fmt: skip
def test_a_scene_that_asks_for_what_there_is_not_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, scene: str, problem: str
) -> None:
    path = tmp_path / "other.toml"
    path.write_text(scene)
    status, _, err = here(capsys, "stability", str(path))
    assert status == 2
    assert problem in err


def test_a_largest_step_beyond_which_nothing_was_looked_at_is_no_limit(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """The step is then the largest that was looked at."""
    path = tmp_path / "free.toml"
    path.write_text(
        'hamiltonian = "p**2/2"\nschemes = ["lie2"]\n'
        "[[largest_step]]\ntime = 1\ninitial_value = { q = 0, p = 1 }\n"
    )
    status, out, _ = here(capsys, "stability", str(path))
    assert status == 0
    assert "bounded up to" not in out
    assert out.count("bounded with every step size looked at, the largest h = ") == 1


# -- in n degrees of freedom ----------------------------------------------------------------------


def test_a_chain_is_judged_with_its_number_of_masses(
    capsys: pytest.CaptureFixture[str],
) -> None:
    chain = ["--system", "fput", "--param", "n=4", "--param", "alpha=1/4", "--param", "beta=0"]
    start = ["--q", "1,0,0,0", "--p", "0,0,0,0", "--step-size", "0.1", "--time", "10"]
    status, shown, _ = here(capsys, "stability", *chain, *start, "--scheme", "stormer-verlet")
    assert (status, shown.split()[0]) == (0, "stable")


def test_linear_theory_decides_step_sizes_where_t_and_v_are_coupled(
    capsys: pytest.CaptureFixture[str],
) -> None:
    options = [*LINEAR, *TRAP, "--step-size", "1.2", "--step-size", "1.5", "--json"]
    status, shown, _ = here(capsys, "stability", *options)
    assert status == 0
    theory = json_of(shown)
    assert [f["exact"] for f in theory["frequencies"]] == ["1/2", "2"]
    assert [x["bounded"] for x in theory["decided"]] == [True, False]
    assert theory["step_size"] is None


def test_orbits_over_two_initial_values(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        'system = "henon-heiles"\nschemes = ["rk4"]\n[[orbit_map]]\naxes = ["q2", "p2"]\n'
        "across = { from = 0, to = 1.2, count = 3 }\nupwards = [0.1]\ntime = 100\n"
        "initial_value = { q = [0, 0], p = [0.1, 0] }\nstep_size = 0.1\n"
    )
    status, shown, _ = here(capsys, "stability", str(file))
    assert (status, shown) == (0, "rk4: orbits over q2 and p2: 2 regular, 1 leaves\n")
