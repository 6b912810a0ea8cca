"""Scenes in one line: what their file says too; the states of a run as CSV; T and h."""

import csv
import io
import shlex
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.test_command_line import here, json_of

PENDULUM = ["--system", "pendulum", "--scheme", "lie2"]
START = ["--q", "1", "--p", "0"]
HEAD = 'name = "pendulum"\nsystem = "pendulum"\nschemes = ["lie2"]\n'
SAME = {
    "flow": (
        [*PENDULUM, *START, "--shape", "square", "--scale", "0.5", "--step-size", "0.1",
         "--time", "0.25", "--time", "1"],
        """[[flow]]
shape = "square"
centre = { q = 1, p = 0 }
scale = 0.5
step_size = 0.1
steps = [2, 10]
""",
    ),
    "stability": (
        [*PENDULUM, *START, "--step-size", "0.1", "--step-size", "3", "--steps", "200"],
        """[[stability]]
step_sizes = [0.1, 3]
steps = 200
initial_values = [{ q = 1, p = 0 }]
""",
    ),
}  # fmt: skip


def without_seconds(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: without_seconds(x) for key, x in data.items() if key != "seconds"}
    return list(map(without_seconds, data)) if isinstance(data, list) else data


@pytest.mark.parametrize("command", SAME)
def test_in_one_line_it_is_what_the_file_says(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, command: str
) -> None:
    options, sections = SAME[command]
    scene = tmp_path / "pendulum.toml"
    scene.write_text(HEAD + sections, encoding="utf-8")
    of_file = here(capsys, command, str(scene), "--json")
    of_line = here(capsys, command, *options, "--json")
    assert of_file[0] == of_line[0] == 0
    assert without_seconds(json_of(of_file[1])) == without_seconds(json_of(of_line[1]))


def test_a_benchmark_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    steps = ["--step-size", "0.1", "--step-size", "0.03", "--time", "1", "--repeats", "1"]
    given = ["bench", *PENDULUM, *START, *steps]
    status, out, _ = here(capsys, *given, "--json")
    assert status == 0
    assert [(x["step_size"], x["steps"]) for x in json_of(out)["points"]] == [
        ("0.1", 10), ("0.03", 33)
    ]  # fmt: skip
    _, shown, _ = here(capsys, *given)
    told = "T/h is rounded down: h = 0.03 gives N = 33, and t = 0.99 at the end"
    assert told in " ".join(shown.split())


def test_a_flow_says_where_its_times_end(capsys: pytest.CaptureFixture[str]) -> None:
    times = ["--time", "1", "--time", "0.6"]
    status, shown, _ = here(capsys, "flow", *PENDULUM, "--step-size", "0.3", *times)
    assert status == 0
    told = "T/h is rounded down: h = 0.3 gives N = 3, and t = 0.9 at the end\n"
    assert shown.endswith(told)
    assert shown.count("rounded down") == 1  # 0.6 is 2 h


BAD = {
    "nothing": (["flow"], "SCENE: is missing; or give --system, --scheme, --step-size"),
    "both": (["flow", "paper", "--q", "1"], "--q=1: goes without SCENE"),
    "no-scheme": (["stability", "--system", "pendulum"], "--scheme: is missing"),
    "no-system": (["flow", "--scheme", "lie2", "--step-size", "1"], "--hamiltonian: give one"),
    "no-start": (["stability", *PENDULUM, "--step-size", "1", "--steps", "3"], "--q: is missing"),
    "no-steps": (["stability", *PENDULUM, *START, "--step-size", "1"], "--time, --steps: give one"),
    "no-time": (["bench", *PENDULUM, *START, "--step-size", "1"], "--time: is missing"),
    "one-size": (["bench", *PENDULUM, *START, "--step-size", "1", "--time", "9"],
                 "--step-size=1: is one; an order takes two"),
    "zero": (["flow", *PENDULUM, "--step-size", "0", "--steps", "3"], "--step-size=0: must be"),
    "flow-short": (["flow", *PENDULUM, "--step-size", "1", "--time", "0.5"],
                   "--step-size=1: makes 0 steps"),
    "flow-alike": (["flow", *PENDULUM, "--step-size", "1", "--time", "1", "--time", "1.5"],
                   "--time=1, 1.5: two of them make the same number of steps"),
    "shape": (["flow", *PENDULUM, "--step-size", "1", "--steps", "3", "--shape", "dog"],
              "--shape=dog: unknown; allowed: cat"),
    "linear": (["stability", "--linear", "--scheme", "lie2", "--q", "1"],
               "--q=1: does not go with --linear"),
    "linear-two": (["stability", "--linear", "--scheme", "lie2", "--scheme", "lie3"],
                   "--scheme=lie2, lie3: give one with --linear"),
    "run-both": (["run", *PENDULUM, *START, "--step-size", "1", "--steps", "3", "--time", "3"],
                 "--steps, --time=3: give one of the two"),
    "run-short": (["run", *PENDULUM, *START, "--step-size", "1", "--time", "0.5"],
                  "--time=0.5: makes 0 steps"),
    "csv-json": (["run", *PENDULUM, *START, "--step-size", "1", "--steps", "3", "--csv", "-",
                  "--json"], "--csv=-: does not go with --json"),
    "points": (["run", *PENDULUM, *START, "--step-size", "1", "--steps", "3", "--points", "3"],
               "--points=3: goes with --csv"),
    "no-points": (["run", *PENDULUM, *START, "--step-size", "1", "--steps", "3", "--points", "0",
                   "--csv", "-"], "--points=0: must be a whole number, 1 … 10000"),
    "csv-folder": (["run", *PENDULUM, *START, "--step-size", "1", "--steps", "3", "--csv", "."],
                   "--csv=.: is a folder"),
    "csv-empty": (["run", *PENDULUM, *START, "--step-size", "1", "--steps", "3", "--csv", ""],
                  "--csv: is empty; give a path"),
    "no-repeats": (["bench", *PENDULUM, *START, "--step-size", "1", "--step-size", "2", "--time",
                    "9", "--repeats", "0"], "--repeats=0: "),
    "no-repeats-of-file": (["bench", "paper", "--repeats", "0"], "--repeats=0: goes without SCENE"),
    "none-at-all": (["stability", *PENDULUM, *START, "--step-size", "1", "--steps", "0"],
                    "--steps=0: "),
}  # fmt: skip


@pytest.mark.parametrize(("given", "told"), BAD.values(), ids=BAD)
def test_a_mistake_names_the_option_as_it_is_typed(
    capsys: pytest.CaptureFixture[str], given: list[str], told: str
) -> None:
    status, out, err = here(capsys, *given)
    assert (status, out) == (2, "")
    assert told in err
    assert err.count("\n") == 1


def table(out: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(out)))


def test_a_run_until_a_time_writes_every_state_from_the_first(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    given = ["run", *PENDULUM, *START, "--step-size", "0.1", "--time", "1.05"]
    status, out, err = here(capsys, *given, "--csv", "-")
    told = "T/h is rounded down: h = 0.1 gives N = 10, and t = 1 at the end\n"
    assert (status, err) == (0, told)
    rows = table(out)
    assert [row["t"] for row in rows] == ["0", *(f"0.{k}" for k in range(1, 10)), "1"]
    assert [*rows[0]] == ["t", "p", "q", "energy_error", "delta_j", "lambda"]
    assert [rows[0][name] for name in ("p", "q", "energy_error", "lambda")] == [
        "0.0", "1.0", "0", "0.0"
    ]  # fmt: skip
    file = tmp_path / "orbit.csv"
    status, shown, _ = here(capsys, *given, "--csv", str(file))
    assert status == 0
    assert file.read_text(encoding="utf-8") == out
    assert shown.endswith(told)
    known = json_of(here(capsys, *given, "--json")[1])
    assert abs(Fraction(rows[-1]["lambda"]) - Fraction(known["lambda"])) < Fraction(1, 10**15)
    area = Fraction(1)
    for row in rows[:-1]:  # ΔJ stands at the state where its step begins
        area *= 1 + Fraction(row["delta_j"])
    assert abs(area - 1 - Fraction(rows[-1]["lambda"])) < Fraction(1, 10**14)


def test_with_digits_the_table_has_them_and_fewer_points_end_at_the_last(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = ["run", *PENDULUM, *START, "--step-size", "1/3", "--steps", "10", "--digits", "30"]
    rows = table(here(capsys, *given, "--csv", "-", "--points", "3")[1])
    assert [row["t"] for row in rows] == ["0", "4/3", "8/3", "10/3"]
    assert len(rows[-1]["q"].strip("-").split("e")[0]) == 31


def test_a_run_that_ends_early_writes_what_was_finite_and_fails(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = ["run", "--hamiltonian", "p**2/2-q**4", "--scheme", "euler", "--q", "1", "--p", "1"]
    status, out, err = here(capsys, *given, "--step-size", "1", "--steps", "100", "--csv", "-")
    assert status == 1
    assert 5 < len(table(out)) < 20
    assert err.startswith("at step ")
    assert "leaves the domain of H or the range of float64" in err


@pytest.mark.parametrize("bad", [["--csv", "."], ["--csv", "orbit.csv", "--points", "0"]], ids=str)
def test_a_table_that_cannot_be_written_is_refused_before_the_run(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    bad: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    given = ["run", *PENDULUM, *START, "--step-size", "1", "--steps", "1000000000000", *bad]
    status, out, err = here(capsys, *given)  # a run of years
    assert (status, out) == (2, "")
    assert err.startswith(f"verify: {bad[-2]}={bad[-1]}: ")


def test_a_page_for_a_scheme_of_ones_own(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    folder = tmp_path / "mine"
    given = ["--hamiltonian", "p**2/2 - cos(q)", "--scheme",
             "p_next = p - h*sin(q); q_next = q + h*p", *START,
             "--step-size", "0.1", "--step-size", "0.2", "--time", "1"]  # fmt: skip
    status, out, _ = here(capsys, "report", *given, "-o", str(folder), "--json")
    assert status == 0
    made = json_of(out)
    (scene,) = made["scenes"]
    assert [(run["step_size"], run["steps"]) for run in scene["runs"]] == [("0.1", 10), ("0.2", 5)]
    assert {x["step_size"] for each in scene["separations"] for x in each["points"]} == {
        "0.1", "0.2"
    }  # fmt: skip
    assert scene["series"][0]["step_size"] == "0.2"
    assert {*given} <= {*shlex.split(made["provenance"]["command"])}
    assert (folder / "index.html").exists()


def test_a_page_in_two_degrees_of_freedom_splits_w(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    given = ["--system", "henon-heiles", "--scheme", "lie2", "--scheme", "stormer-verlet",
             "--q", "0,0.1", "--p", "0.4,0", "--step-size", "0.1", "--time", "10"]  # fmt: skip
    status, out, _ = here(capsys, "report", *given, "-o", str(tmp_path / "mine"), "--json")
    assert status == 0
    made = json_of(out)
    (scene,) = made["scenes"]
    (split,) = scene["form_separations"]
    assert [x["scheme"] for x in split["points"]] == ["lie2"]
    assert any("stormer-verlet" in x and "exactly 0" in why for x, why in made["left_out"])
