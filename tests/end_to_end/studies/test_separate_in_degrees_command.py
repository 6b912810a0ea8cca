"""`verify separate` in n degrees of freedom: its JSON keys, sums, text for people, bad input."""

from fractions import Fraction
from typing import Any

import pytest

from tests.end_to_end.test_command_line import DECIMAL, arguments, here, json_of

SEPARATE = {"--system": "henon-heiles", "--scheme": "lie2", "--step-size": "0.1", "--steps": "40",
            "--q": "0.3,-0.1", "--p": "0.1,0.2"}  # fmt: skip
DRIVEN = ["--system", "driven-henon-heiles", "--param", "epsilon=1/10", "--param", "omega=7/5"]
PARTS = ("input", "trajectory", "derivatives", "product")
WHOLES = ("w_working", "truncation")


def separated(capsys: pytest.CaptureFixture[str], *more: str, **changes: Any) -> Any:
    status, out, err = here(capsys, *arguments("separate", SEPARATE, **changes), *more, "--json")
    assert (status, err) == (0, "")
    return json_of(out)


def matrices(way: Any) -> dict[str, list[list[Fraction]]]:
    shown = {name: way[name] for name in WHOLES} | way["rounding"]
    return {n: [[Fraction(x) for x in row] for row in rows] for n, rows in shown.items()}


def test_every_part_is_an_antisymmetric_matrix_of_decimal_strings(
    capsys: pytest.CaptureFixture[str],
) -> None:
    found = separated(capsys)
    assert found["coordinates"] == ["p1", "p2", "q1", "q2"]
    assert set(found["rounding"]) == {"total", *PARTS}
    assert set(found["error_bound"]) == {*WHOLES, "total", *PARTS}
    for way in (found, found["closed_form"]):
        shown = {name: way[name] for name in WHOLES} | way["rounding"] | way["error_bound"]
        assert all(DECIMAL.fullmatch(x) for rows in shown.values() for row in rows for x in row)
        for rows in matrices(way).values():
            assert [len(row) for row in rows] == [4] * 4
            assert all(rows[a][b] == -rows[b][a] for a in range(4) for b in range(4))
    tangent = found["tangent"]
    assert tangent["time"] == "4"
    assert DECIMAL.fullmatch(tangent["finite_time_lyapunov"])
    assert found["series"][-1]["steps"] == 40


@pytest.mark.parametrize("digits", ["5", "17", "30"])
def test_the_printed_parts_add_up_within_their_bounds(
    capsys: pytest.CaptureFixture[str], digits: str
) -> None:
    found = separated(capsys, digits=digits)
    for way in (found, found["closed_form"]):
        values, bounds = matrices(way), way["error_bound"]
        for a in range(4):
            for b in range(4):
                parts = sum(values[n][a][b] for n in ("truncation", *PARTS))
                names = ("truncation", "w_working", *PARTS)
                slack = sum(Fraction(bounds[n][a][b]) for n in names)
                assert abs(parts - values["w_working"][a][b]) <= slack


def test_in_time_the_clock_is_a_part(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = here(
        capsys, "separate", *DRIVEN, "--scheme", "lie2", "--step-size", "0.1", "--steps", "30",
        "--q", "0.3,-0.1", "--p", "0.1,0.2", "--json",
    )  # fmt: skip
    assert status == 0
    found = json_of(out)
    assert set(found["rounding"]) == {"total", "clock", *PARTS}
    assert any(any(map(Fraction, row)) for row in found["rounding"]["clock"])


@pytest.mark.left_to_ci
def test_people_read_the_greatest_entries_and_what_grew(
    capsys: pytest.CaptureFixture[str],
) -> None:
    given = {**SEPARATE, "--scheme": "rk4", "--step-size": "0.2"}
    given |= {"--time": "200", "--q": "0,-0.15", "--p": "0.5277,0"}
    given.pop("--steps")
    status, out, _ = here(capsys, *arguments("separate", given))
    assert status == 0
    for line in ("W in float64", "    derivatives", "finite-time Lyapunov exponent"):
        assert line in out
    assert "that growth is the motion's, not the scheme's" in out, "at H = 1/7 it is chaotic"
    status, out, _ = here(capsys, *arguments("separate", SEPARATE))
    assert "the motion's" not in out


def test_of_a_scheme_that_solves_equations_all_of_w_is_rounding(
    capsys: pytest.CaptureFixture[str],
) -> None:
    found = separated(capsys, scheme="implicit-midpoint")
    assert found["status"] == "finished"
    assert not any(any(map(Fraction, row)) for row in found["truncation"])
    assert any(any(map(Fraction, row)) for row in found["rounding"]["total"])


def test_an_orbit_that_leaves_the_range_says_where(capsys: pytest.CaptureFixture[str]) -> None:
    found = separated(capsys, q="0.9,0.9", steps="2000", step_size="0.05")
    assert (found["status"], found["failed_step"], found["w_working"]) == ("left range", 121, None)


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"q": "0.3"}, "--q=0.3: has 1 of 2 numbers; H is of q1, q2"),
        ({"p": "0.1,x"}, "p2=x"),
        ({"step_size": "0"}, "--step-size=0"),
        ({"arithmetic": "float64"}, "is what is examined"),
    ],
)
def test_bad_input_is_refused_in_one_line(
    capsys: pytest.CaptureFixture[str], changes: dict[str, str], problem: str
) -> None:
    status, out, err = here(capsys, *arguments("separate", SEPARATE, **changes))
    assert (status, out) == (2, "")
    assert problem in err
    assert err.count("\n") == 1
