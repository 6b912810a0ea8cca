"""`verify prove --certificate` and `verify certificate check`, and linear stability."""

import json
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import here, json_of

ONE = ["prove", "--system", "pendulum", "--scheme", "lie2"]
EVERY = ["prove", "--every-hamiltonian", "--scheme", "lie4"]
DRIVEN = ["prove", "--system", "driven-pendulum", "--scheme", "lie2"]
HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
IN_TWO_DEGREES = ["prove", "--hamiltonian", HENON, "--scheme", "lie2"]
EVERY_IN_TWO_DEGREES = ["prove", "--every-hamiltonian", "--degrees", "2", "--scheme", "lie2"]
EVERY_IN_TIME = ["prove", "--every-hamiltonian", "--time-dependent", "--scheme", "lie3"]
# H has functions, or the map stages, of which there are no polynomials.
OTHERS = [
    ["prove", "--hamiltonian", "p**2/2 + log(q)", "--scheme", "lie2"],
    ["prove", "--system", "pendulum", "--scheme", "stormer-verlet"],
    ["prove", "--hamiltonian", "p**2/2 + t*log(q)", "--scheme", "lie2"],
    ["prove", "--system", "driven-pendulum", "--scheme", "stormer-verlet"],
    ["prove", "--system", "pendulum", "--scheme", "yoshida4"],
    ["prove", "--system", "harmonic", "--scheme", "mclachlan4"],
    ["prove", "--system", "driven-pendulum", "--scheme", "gauss4"],
    ["prove", "--system", "henon-heiles", "--scheme", "gauss6"],
    ["prove", "--hamiltonian", HENON, "--scheme", "stormer-verlet"],
]
SAID = [
    (ONE, "for this H and this map"),
    (IN_TWO_DEGREES, "for this H and this map"),
    (DRIVEN, "for this H"),
    (EVERY, "every smooth H"),
    (EVERY_IN_TWO_DEGREES, "every smooth H in 2 degrees of freedom"),
    (EVERY_IN_TIME, "every smooth H"),
    *((command, "for every smooth H") for command in OTHERS[:-1]),
    (OTHERS[-1], "= 0 for every smooth H = T(p) + V(q) in 2"),
]


@pytest.mark.parametrize(("command", "said"), SAID, ids=[" ".join(command) for command, _ in SAID])
def test_what_is_proved_has_a_certificate_that_holds(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, command: list[str], said: str
) -> None:
    path = tmp_path / "c.json"
    status, out, err = here(capsys, *command, "--certificate", str(path))
    assert status == 0
    assert out.startswith("PROVED")
    assert ("for every H" in err) is (command in OTHERS)
    status, out, _ = here(capsys, "certificate", "check", str(path))
    assert (status, out.split(":")[0], said in out) == (0, "holds", True)
    found = json_of(here(capsys, "certificate", "check", str(path), "--json")[1])
    in_two = HENON in command or "henon-heiles" in command or "--degrees" in command
    assert (found["accepted"], found["degrees"]) == (True, 2 if in_two else 1)
    timed = "driven-pendulum" in command or "--time-dependent" in command or "t*log" in str(command)
    assert (", t)" in out or "cos(t" in out or "cos(omega*t" in out) is timed


def test_a_changed_certificate_is_refused_with_status_1(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "c.json"
    here(capsys, *ONE, "--certificate", str(path))
    data = json.loads(path.read_text())
    data["leading"][0][0] = "1/3"
    path.write_text(json.dumps(data))
    status, out, _ = here(capsys, "certificate", "check", str(path), "--json")
    assert status == 1
    assert json_of(out)["accepted"] is False
    assert "det 3" in json_of(out)["reason"]


def test_what_is_refuted_gets_none(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    command = ["prove", "--system", "pendulum", "--scheme", "p_next = p; q_next = q"]
    status, _, err = here(capsys, *command, "--certificate", str(path))
    assert status == 2
    assert "nothing to certify" in err
    assert not path.exists()


def test_linear_stability_is_exact(capsys: pytest.CaptureFixture[str]) -> None:
    command = ["stability", "--linear", "--scheme", "lie4"]
    found = json_of(here(capsys, *command, "--json")[1])
    assert found["interval_exact"] == "2*sqrt(2)"
    assert found["interval"].startswith("2.828427124746190097603377448")
    assert "2*sqrt(2)" in here(capsys, *command)[1]
    # At hω = 2 the matrix has a double eigenvalue −1, and its powers grow.
    told = here(capsys, "stability", "--linear", "--scheme", "stormer-verlet")[1]
    assert "for 0 < hω < 2.0" in told
    assert here(capsys, "stability", "--scheme", "lie4")[0] == 2
