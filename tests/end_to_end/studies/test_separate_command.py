"""`verify separate`: its JSON keys, sums of what is printed, text for people, bad input."""

import os
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest

from tests.end_to_end.test_command_line import DECIMAL, IMPORTED, arguments, here, json_of

PLANE = {"--system": "pendulum", "--scheme": "lie2", "--step-size": "0.01", "--steps": "40",
         "--q": "1.5", "--p": "-0.5"}  # fmt: skip
DEGREES = {"--system": "henon-heiles", "--scheme": "lie2", "--step-size": "0.1", "--steps": "40",
           "--q": "0.3,-0.1", "--p": "0.1,0.2"}  # fmt: skip
DRIVEN = ["--system", "driven-henon-heiles", "--param", "epsilon=1/10", "--param", "omega=7/5"]
WORKING = {"pendulum": "lambda_working", "henon-heiles": "w_working"}
PARTS = {
    "pendulum": ("input", "trajectory", "determinant", "product"),
    "henon-heiles": ("input", "trajectory", "derivatives", "product"),
}


def separated(capsys: pytest.CaptureFixture[str], options: dict[str, str], **changes: Any) -> Any:
    status, out, err = here(capsys, *arguments("separate", options, **changes), "--json")
    assert (status, err) == (0, "")
    return json_of(out)


def entries(part: str | list[list[str]]) -> list[str]:
    """A number, or all numbers of a matrix."""
    return [part] if isinstance(part, str) else [x for row in part for x in row]


def values_of(way: Any, working: str) -> dict[str, Any]:
    return {name: way[name] for name in (working, "truncation")} | way["rounding"]


@pytest.mark.parametrize(
    ("options", "changes"),
    [
        (PLANE, {}),
        (PLANE, {"step_size": ["0.01", "0.02"]}),
        (PLANE, {"arithmetic": "mpmath"}),
        (DEGREES, {}),
    ],
    ids=["plane", "plane-grid", "plane-mpmath", "degrees"],
)
def test_separate_prints_its_json_keys_with_decimal_strings(
    capsys: pytest.CaptureFixture[str], options: dict[str, str], changes: dict[str, Any]
) -> None:
    answer = separated(capsys, options, **changes)
    working, parts = WORKING[options["--system"]], PARTS[options["--system"]]
    assert answer["arithmetic"] == changes.get("arithmetic", "mpfr")
    assert len(answer["grid"]) == len(changes.get("step_size", ["0.01"]))
    assert set(answer["crossover"]) == {"plain", "closed_form"}
    for point in (answer, *answer["grid"]):
        assert (point["status"], point["failed_step"], point["steps"]) == ("finished", None, 40)
        for way in (point, point["closed_form"]):
            assert set(way["rounding"]) == {"total", *parts}
            assert set(way["error_bound"]) == {working, "truncation", "total", *parts}
            for part in (*values_of(way, working).values(), *way["error_bound"].values()):
                assert all(DECIMAL.fullmatch(value) for value in entries(part))
            assert way["error_kind"] in ("enclosed", "estimated")
            assert way["growth"]["total"]["name"] == "undecided", "40 steps are too few"
            assert way["series"][-1]["steps"] == 40


def test_every_part_of_w_is_an_antisymmetric_matrix_beside_the_tangent_maps_growth(
    capsys: pytest.CaptureFixture[str],
) -> None:
    answer = separated(capsys, DEGREES)
    assert answer["coordinates"] == ["p1", "p2", "q1", "q2"]
    for way in (answer, answer["closed_form"]):
        for part in values_of(way, "w_working").values():
            rows = [[Fraction(x) for x in row] for row in part]
            assert [len(row) for row in rows] == [4] * 4
            assert all(rows[a][b] == -rows[b][a] for a in range(4) for b in range(4))
    assert answer["tangent"]["time"] == "4"
    assert DECIMAL.fullmatch(answer["tangent"]["finite_time_lyapunov"])


@pytest.mark.parametrize(
    ("options", "digits"),
    [(PLANE, 5), (PLANE, 17), (PLANE, 40), (DEGREES, 5), (DEGREES, 17), (DEGREES, 30)],
    ids=["plane-5", "plane-17", "plane-40", "degrees-5", "degrees-17", "degrees-30"],
)
def test_the_printed_parts_add_up_within_their_bounds(
    capsys: pytest.CaptureFixture[str], options: dict[str, str], digits: int
) -> None:
    answer = separated(capsys, options, digits=str(digits))
    working, parts = WORKING[options["--system"]], PARTS[options["--system"]]
    for way in (answer, answer["closed_form"]):
        texts = {name: entries(part) for name, part in values_of(way, working).items()}
        bounds = {name: entries(part) for name, part in way["error_bound"].items()}
        for k in range(len(texts[working])):
            value = {name: Fraction(part[k]) for name, part in texts.items()}
            bound = {name: Fraction(part[k]) for name, part in bounds.items()}
            rounding, slack = (sum(x[name] for name in parts) for x in (value, bound))
            assert abs(rounding - value["total"]) <= slack + bound["total"]
            whole = value["truncation"] + rounding
            assert abs(whole - value[working]) <= slack + bound["truncation"] + bound[working]
            for name in ("truncation", *parts):
                assert bound[name] <= abs(value[name]) / 10 ** (digits - 1), name
            printed = Decimal(texts["truncation"][k]).as_tuple().digits
            assert not value["truncation"] or len(printed) in (digits - 1, digits)


def test_in_time_the_clock_is_a_part(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = here(
        capsys, "separate", *DRIVEN, "--scheme", "lie2", "--step-size", "0.1", "--steps", "30",
        "--q", "0.3,-0.1", "--p", "0.1,0.2", "--json",
    )  # fmt: skip
    assert status == 0
    answer = json_of(out)
    assert set(answer["rounding"]) == {"total", "clock", *PARTS["henon-heiles"]}
    assert any(map(Fraction, entries(answer["rounding"]["clock"])))


def test_of_a_scheme_that_solves_equations_all_of_w_is_rounding(
    capsys: pytest.CaptureFixture[str],
) -> None:
    answer = separated(capsys, DEGREES, scheme="implicit-midpoint")
    assert answer["status"] == "finished"
    assert not any(map(Fraction, entries(answer["truncation"])))
    assert any(map(Fraction, entries(answer["rounding"]["total"])))


@pytest.mark.parametrize(
    ("options", "changes", "step"),
    [
        (PLANE, {"system": None, "hamiltonian": "p**2/2 - q**4", "step_size": "1", "steps": "90"},
         6),
        (DEGREES, {"q": "0.9,0.9", "step_size": "0.05", "steps": "2000"}, 121),
    ],
    ids=["plane", "degrees"],
)  # fmt: skip
def test_a_run_that_leaves_the_range_says_at_which_step(
    capsys: pytest.CaptureFixture[str], options: dict[str, str], changes: dict[str, Any], step: int
) -> None:
    answer = separated(capsys, options, **changes)
    assert (answer["status"], answer["failed_step"]) == ("left range", step)
    assert answer[WORKING[options["--system"]]] is None
    assert "float64" in answer["reason"]
    status, out, err = here(capsys, *arguments("separate", options, **changes))
    assert (status, err) == (0, "")
    assert f"left range at step {step}" in out


def test_people_are_shown_a_table_and_the_crossover(capsys: pytest.CaptureFixture[str]) -> None:
    given = arguments("separate", PLANE, step_size=["0.01", "0.1"], steps=None, time="4")
    status, out, err = here(capsys, *given)
    assert (status, err) == (0, "")
    assert out.count("determinant") == 2
    assert "h = 0.1, 40 steps" in out
    assert "rounding overtakes truncation, plain: none in this range" in out


@pytest.mark.left_to_ci
def test_people_read_the_greatest_entries_and_what_grew(
    capsys: pytest.CaptureFixture[str],
) -> None:
    options = {**DEGREES, "--scheme": "rk4", "--step-size": "0.2"}
    options |= {"--time": "200", "--q": "0,-0.15", "--p": "0.5277,0"}
    options.pop("--steps")
    status, out, _ = here(capsys, *arguments("separate", options))
    assert status == 0
    for line in ("W in float64", "    derivatives", "finite-time Lyapunov exponent"):
        assert line in out
    assert "that growth is the motion's, not the scheme's" in out, "at H = 1/7 it is chaotic"
    status, out, _ = here(capsys, *arguments("separate", DEGREES))
    assert "the motion's" not in out


BAD = {
    "h-zero": (PLANE, {"step_size": "0"}, "--step-size=0"),
    "h-second": (PLANE, {"step_size": ["0.1", "nan"]}, "--step-size=nan"),
    "h-twice": (PLANE, {"step_size": ["0.1", "1/10"]}, "--step-size=1/10: is given twice"),
    "h-missing": (PLANE, {"step_size": None}, "--step-size"),
    "n-zero": (PLANE, {"steps": "0"}, "steps=0"),
    "n-word": (PLANE, {"steps": "many"}, "--steps"),
    "n-and-time": (PLANE, {"time": "3"}, "--steps, --time: give one of the two"),
    "n-nor-time": (PLANE, {"steps": None}, "--steps, --time: give one of the two"),
    "time-short": (PLANE, {"steps": None, "time": "0.001"}, "time=0.001: is shorter"),
    "time-negative": (PLANE, {"steps": None, "time": "-1"}, "time=-1: must be greater than 0"),
    "time-long": (PLANE, {"steps": None, "time": "1e30"}, "steps="),
    "digits": (PLANE, {"digits": "0"}, "digits=0"),
    "float64": (PLANE, {"arithmetic": "float64"}, "arithmetic=float64: is what is examined"),
    "arithmetic": (PLANE, {"arithmetic": "posit"}, "arithmetic=posit: unknown"),
    "parameter": (PLANE, {"system": "duffing"}, "parameter=delta: has no value"),
    "scheme": (PLANE, {"scheme": "rk5"}, "scheme=rk5"),
    "system": (PLANE, {"system": None}, "--system, --hamiltonian"),
    "q": (PLANE, {"q": "inf"}, "q=inf"),
    "too-few": (DEGREES, {"q": "0.3"}, "--q=0.3: has 1 of 2 numbers; H is of q1, q2"),
    "p2": (DEGREES, {"p": "0.1,x"}, "p2=x"),
    "degrees-h-zero": (DEGREES, {"step_size": "0"}, "--step-size=0"),
    "degrees-float64": (DEGREES, {"arithmetic": "float64"}, "is what is examined"),
}


@pytest.mark.parametrize("as_json", [False, True], ids=["text", "json"])
@pytest.mark.parametrize(("options", "changes", "named"), BAD.values(), ids=BAD)
def test_bad_input_is_one_line_on_standard_error_and_status_2(
    capsys: pytest.CaptureFixture[str], options: dict[str, str], changes: dict[str, Any],
    named: str, as_json: bool,
) -> None:  # fmt: skip
    line = arguments("separate", options, **changes) + (["--json"] if as_json else [])
    status, out, err = here(capsys, *line)
    assert (status, out) == (2, "")
    assert err.startswith("verify: ")
    assert err.count("\n") == 1
    assert named in err


@pytest.mark.left_to_ci
def test_separate_imports_no_compiler() -> None:
    done = subprocess.run(
        [sys.executable, "-c", IMPORTED, *arguments("separate", PLANE)],
        capture_output=True, text=True, env={**os.environ, "COLUMNS": "80"}, check=True,
    )  # fmt: skip
    modules = set(done.stderr.rpartition("IMPORTED")[2].split())
    assert "gmpy2" in modules
    assert not modules & {"matplotlib", "numpy", "jinja2"}
