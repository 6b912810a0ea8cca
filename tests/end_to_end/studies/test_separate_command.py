"""`verify separate`: its JSON keys, sums of what is printed, text for people, bad input."""

import os
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest

from tests.end_to_end.test_command_line import DECIMAL, IMPORTED, arguments, here, json_of

SEPARATE = {"--system": "pendulum", "--scheme": "lie2", "--step-size": "0.01", "--steps": "40",
            "--q": "1.5", "--p": "-0.5"}  # fmt: skip
PARTS = ("input", "trajectory", "determinant", "product")


def separated(capsys: pytest.CaptureFixture[str], **changes: Any) -> Any:
    status, out, err = here(capsys, *arguments("separate", SEPARATE, **changes), "--json")
    assert (status, err) == (0, "")
    return json_of(out)


@pytest.mark.parametrize("given", [{}, {"step_size": ["0.01", "0.02"]}, {"arithmetic": "mpmath"}])
def test_separate_prints_its_json_keys_with_decimal_strings(
    capsys: pytest.CaptureFixture[str], given: dict[str, Any]
) -> None:
    found = separated(capsys, **given)
    assert found["arithmetic"] == given.get("arithmetic", "mpfr")
    assert len(found["grid"]) == len(given.get("step_size", ["0.01"]))
    assert set(found["crossover"]) == {"plain", "closed_form"}
    for point in (found, *found["grid"]):
        assert (point["status"], point["failed_step"], point["steps"]) == ("finished", None, 40)
        for way in (point, point["closed_form"]):
            assert set(way["rounding"]) == {"total", *PARTS}
            assert set(way["error_bound"]) == {"lambda_working", "truncation", "total", *PARTS}
            values = {n: way[n] for n in ("lambda_working", "truncation")} | way["rounding"]
            assert all(DECIMAL.fullmatch(value) for value in values.values())
            assert way["error_kind"] in ("enclosed", "estimated")
            assert way["growth"]["total"]["name"] == "undecided", "40 steps are too few"
            assert way["series"][-1]["steps"] == 40


@pytest.mark.parametrize("digits", ["5", "17", "40"])
def test_the_printed_parts_add_up_within_their_bounds(
    capsys: pytest.CaptureFixture[str], digits: str
) -> None:
    found = separated(capsys, digits=digits)
    for way in (found, found["closed_form"]):
        bounds = {n: Fraction(x) for n, x in way["error_bound"].items()}
        parts = {n: Fraction(way["rounding"][n]) for n in PARTS}
        truncation, whole = Fraction(way["truncation"]), Fraction(way["lambda_working"])
        slack = sum(bounds[n] for n in PARTS)
        assert abs(sum(parts.values()) - Fraction(way["rounding"]["total"])) <= (
            slack + bounds["total"]
        )
        assert abs(truncation + sum(parts.values()) - whole) <= (
            slack + bounds["truncation"] + bounds["lambda_working"]
        )
        for name, value in {**parts, "truncation": truncation}.items():
            assert bounds[name] <= abs(value) / 10 ** (int(digits) - 1), name
        printed = Decimal(way["truncation"]).as_tuple().digits
        assert len(printed) in (int(digits) - 1, int(digits))


def test_a_run_that_leaves_the_range_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    changes = {"system": None, "hamiltonian": "p**2/2 - q**4", "step_size": "1", "steps": "90"}
    found = separated(capsys, **changes)
    assert (found["status"], found["lambda_working"]) == ("left range", None)
    assert 1 < int(found["failed_step"]) < 90
    assert "float64" in found["reason"]
    status, out, err = here(capsys, *arguments("separate", SEPARATE, **changes))
    assert (status, err) == (0, "")
    assert f"left range at step {found['failed_step']}" in out


def test_people_are_shown_a_table_and_the_crossover(capsys: pytest.CaptureFixture[str]) -> None:
    given = arguments("separate", SEPARATE, step_size=["0.01", "0.1"], steps=None, time="4")
    status, out, err = here(capsys, *given)
    assert (status, err) == (0, "")
    assert out.count("determinant") == 2
    assert "h = 0.1, 40 steps" in out
    assert "rounding overtakes truncation, plain: none in this range" in out


BAD = {
    "h-zero": ({"step_size": "0"}, "--step-size=0"),
    "h-second": ({"step_size": ["0.1", "nan"]}, "--step-size=nan"),
    "h-twice": ({"step_size": ["0.1", "1/10"]}, "--step-size=1/10: is given twice"),
    "h-missing": ({"step_size": None}, "--step-size"),
    "n-zero": ({"steps": "0"}, "steps=0"),
    "n-word": ({"steps": "many"}, "--steps"),
    "n-and-time": ({"time": "3"}, "--steps, --time: give one of the two"),
    "n-nor-time": ({"steps": None}, "--steps, --time: give one of the two"),
    "time-short": ({"steps": None, "time": "0.001"}, "time=0.001: is shorter"),
    "time-negative": ({"steps": None, "time": "-1"}, "time=-1: must be greater than 0"),
    "time-long": ({"steps": None, "time": "1e30"}, "steps="),
    "digits": ({"digits": "0"}, "digits=0"),
    "float64": ({"arithmetic": "float64"}, "arithmetic=float64: is what is examined"),
    "arithmetic": ({"arithmetic": "posit"}, "arithmetic=posit: unknown"),
    "parameter": ({"system": "duffing"}, "parameter=delta: has no value"),
    "scheme": ({"scheme": "rk5"}, "scheme=rk5"),
    "system": ({"system": None}, "--system, --hamiltonian"),
    "q": ({"q": "inf"}, "q=inf"),
}


@pytest.mark.parametrize("as_json", [False, True], ids=["text", "json"])
@pytest.mark.parametrize(("changes", "named"), BAD.values(), ids=BAD)
def test_bad_input_is_one_line_on_standard_error_and_status_2(
    capsys: pytest.CaptureFixture[str], changes: dict[str, Any], named: str, as_json: bool
) -> None:
    given = arguments("separate", SEPARATE, **changes) + (["--json"] if as_json else [])
    status, out, err = here(capsys, *given)
    assert (status, out) == (2, "")
    assert err.startswith("verify: ")
    assert err.count("\n") == 1
    assert named in err


@pytest.mark.left_to_ci
def test_separate_imports_no_compiler() -> None:
    done = subprocess.run(
        [sys.executable, "-c", IMPORTED, *arguments("separate", SEPARATE)],
        capture_output=True, text=True, env={**os.environ, "COLUMNS": "80"}, check=True,
    )  # fmt: skip
    modules = set(done.stderr.rpartition("IMPORTED")[2].split())
    assert "gmpy2" in modules
    assert not modules & {"matplotlib", "numpy", "jinja2"}
