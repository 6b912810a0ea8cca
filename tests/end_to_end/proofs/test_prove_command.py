"""`verify prove`: its JSON, its text and its exit status, in one degree of freedom and in two."""

from typing import Any

import pytest

import verify
from tests.end_to_end.test_command_line import DECIMAL, here, json_of

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
EVERY = ("prove", "--every-hamiltonian")
COMMANDS = {
    "n = 1": ("prove", "--system", "duffing"),
    "n = 2": ("prove", "--hamiltonian", HENON),
    "every H": EVERY,
    "every H, n = 1": (*EVERY, "--degrees", "1"),
    "every H, n = 2": (*EVERY, "--degrees", "2"),
}
OWN = "p1_next = p1; p2_next = p2; q1_next = q1; q2_next = q2"
IN_THE_PLANE = {
    "verdict": "PROVED", "order": 3, "defect_order": 3, "convergence_order": 2,
    "leading": "3*delta*p*q", "symplectic": False, "area_preserving": False, "telescopes": True,
}  # fmt: skip
IN_TWO_DEGREES = IN_THE_PLANE | {
    "degrees": 2, "volume_order": 4, "volume_leading": "2*q1**2 + 2*q2**2 + 1/2",
    "leading": "(p2)*dp1∧dq1 + (p1)*dp1∧dq2 + (p1)*dp2∧dq1 + (-p2)*dp2∧dq2",
}  # fmt: skip


@pytest.mark.parametrize(
    ("typed", "expected", "entries", "moved"),
    [
        pytest.param(COMMANDS["n = 1"], IN_THE_PLANE, 0, "p", id="n = 1"),
        pytest.param(COMMANDS["n = 2"], IN_TWO_DEGREES, 4, "p2", id="n = 2"),
    ],
)
def test_its_json_has_what_is_proved(
    capsys: pytest.CaptureFixture[str],
    typed: tuple[str, ...],
    expected: dict[str, Any],
    entries: int,
    moved: str,
) -> None:
    status, out, err = here(capsys, *typed, "--scheme", "lie2", "--json")
    found = json_of(out)
    assert (status, err) == (0, "")
    assert {name: found[name] for name in expected} == expected
    assert "delta_j" in found
    assert found["potential"].count("∧") == entries
    assert found["witness"][moved]
    assert DECIMAL.fullmatch(found["seconds"])


@pytest.mark.parametrize("scheme", ["stormer-verlet", "gauss4", "symplectic-euler"])
@pytest.mark.parametrize("name", COMMANDS)
def test_what_is_symplectic_says_so(
    capsys: pytest.CaptureFixture[str], name: str, scheme: str
) -> None:
    status, out, _ = here(capsys, *COMMANDS[name], "--scheme", scheme, "--json")
    found = json_of(out)
    assert (status, found["order"]) == (0, None)
    assert (found["symplectic"], found["area_preserving"]) == (True, True)
    assert (found["delta_j"], found["leading"]) == ("0", "0")
    assert all(c["holds"] for c in found.get("conditions", []))


@pytest.mark.parametrize("name", COMMANDS)
def test_what_is_not_symplectic_says_so(capsys: pytest.CaptureFixture[str], name: str) -> None:
    found = json_of(here(capsys, *COMMANDS[name], "--scheme", "lie2", "--json")[1])
    assert (found["symplectic"], found["area_preserving"]) == (False, False)


def test_a_long_form_is_named_and_not_written_out(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = here(capsys, *COMMANDS["every H, n = 2"], "--scheme", "lie4", "--json")
    found = json_of(out)
    assert (status, found["leading"]) == (0, found["formula"])
    assert found["formula"].startswith("−1/5! Σ_i (d(X^5 p_i)∧dq_i")
    assert found["why"].startswith("β = −1/5! Σ_k")


def test_a_proof_for_every_h_has_the_keys_of_one(capsys: pytest.CaptureFixture[str]) -> None:
    found = json_of(here(capsys, *EVERY, "--scheme", "lie4", "--json")[1])
    assert found["order"] == 5
    assert found["telescopes"] is True
    assert found["potential"]
    one = ("prove", "--system", "pendulum", "--scheme", "lie2", "--json")
    assert set(json_of(here(capsys, *one)[1])) - {"parameters", "witness"} <= set(found)


@pytest.mark.parametrize(
    ("typed", "status", "said"),
    [
        ((*COMMANDS["n = 2"], "--scheme", OWN), 1, "REFUTED: p1_next = p1; "),
        ((*COMMANDS["n = 2"], "--scheme", "p_next = p; q_next = q"), 2, "H needs p1_next, p2_next"),
        ((*EVERY, "--scheme", "lie2", "--degrees", "65"), 2, "--degrees=65: must be 1 … 64"),
        ((*EVERY, "--scheme", "lie2", "--degrees", "20"), 2, "derivatives of H would be needed"),
        ((*EVERY, "--scheme", "lie2", "--degrees", "x"), 2, "--degrees=x"),
        ((*COMMANDS["n = 2"], "--degrees", "2", "--scheme", "lie2"), 2,
         "--degrees: goes with --every"),
        ((*EVERY, "--scheme", "lie4", "--system", "duffing"), 2, "--every-hamiltonian"),
        ((*EVERY, "--scheme", "lie4", "--param", "a=1"), 2, "--every-hamiltonian"),
        ((*EVERY, "--scheme", "lie4", "--hamiltonian", "p**2"), 2, "--every-hamiltonian"),
    ],
)  # fmt: skip
def test_what_is_refuted_or_refused_is_said(
    capsys: pytest.CaptureFixture[str], typed: tuple[str, ...], status: int, said: str
) -> None:
    found, out, err = here(capsys, *typed)
    assert (found, said in (out if status == 1 else err)) == (status, True)
    assert status < 2 or err.count("\n") == 1


def test_a_proof_is_shown_in_python_by_its_verdict_and_reason() -> None:
    found = verify.prove(HENON, "lie2")
    assert repr(found) == (
        "Proof(PROVED: the coefficients of S below h^3 vanish identically, that of h^3 does not)"
    )
