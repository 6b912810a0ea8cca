"""`verify bench` of H(p1 … pn, q1 … qn): W beside errors, bad input."""

import pytest

from tests.end_to_end.test_command_line import here, json_of

HENON = ["--system", "henon-heiles", "--q", "0,0.1", "--p", "0.4,0"]


def test_bench_has_w_beside_errors(capsys: pytest.CaptureFixture[str]) -> None:
    sizes = ["--step-size", "0.1", "--step-size", "0.05", "--time", "1", "--repeats", "1"]
    schemes = ["--scheme", "lie2", "--scheme", "stormer-verlet"]
    status, out, _ = here(capsys, "bench", *HENON, *schemes, *sizes, "--json")
    assert status == 0
    answer = json_of(out)
    assert answer["scenes"][0]["q"] == ["0", "0.1"]
    defects = {x["scheme"]: x["symplectic_defect"] for x in answer["points"] if x["step_size"]}
    assert float(defects["lie2"]) > 0
    assert float(defects["stormer-verlet"]) == 0
    status, shown, _ = here(capsys, "bench", *HENON, *schemes, *sizes)
    assert status == 0
    assert "max |W|" in shown


def test_a_start_of_another_length_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--scheme", "rk4", "--step-size", "0.1", "--step-size", "0.05", "--time", "1"]
    start = ["--system", "henon-heiles", "--q", "0,0.1", "--p", "0.4"]
    status, out, err = here(capsys, "bench", *start, *options)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert "--p=0.4: has 1 of 2 numbers" in err
