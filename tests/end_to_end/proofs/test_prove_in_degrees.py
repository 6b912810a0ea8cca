"""`verify prove` in several degrees of freedom: its JSON, its text and its exit status."""

from pathlib import Path

import pytest

import verify
from tests.end_to_end.test_command_line import here, json_of

HENON = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
ONE = ("prove", "--hamiltonian", HENON)
EVERY = ("prove", "--every-hamiltonian", "--degrees", "2")
OWN = "p1_next = p1; p2_next = p2; q1_next = q1; q2_next = q2"


def test_its_json_has_what_is_proved(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = here(capsys, *ONE, "--scheme", "lie2", "--json")
    found = json_of(out)
    assert (status, found["verdict"], found["degrees"]) == (0, "PROVED", 2)
    assert (found["order"], found["volume_order"], found["convergence_order"]) == (3, 4, 2)
    assert found["leading"] == "(p2)*dp1∧dq1 + (p1)*dp1∧dq2 + (p1)*dp2∧dq1 + (-p2)*dp2∧dq2"
    assert found["volume_leading"] == "2*q1**2 + 2*q2**2 + 1/2"
    assert (found["symplectic"], found["area_preserving"]) == (False, False)
    assert (found["telescopes"], found["potential"].count("∧")) == (True, 4)
    assert found["witness"][found["leading"][1:3]]


def test_what_is_symplectic_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    for typed in (ONE, EVERY):
        for scheme in ("stormer-verlet", "gauss4"):
            status, out, _ = here(capsys, *typed, "--scheme", scheme, "--json")
            found = json_of(out)
            assert (status, found["symplectic"], found["order"]) == (0, True, None)
            assert (found["delta_j"], found["leading"]) == ("0", "0")
            assert all(c["holds"] for c in found["conditions"])


def test_in_the_plane_symplectic_is_that_area_is_preserved(
    capsys: pytest.CaptureFixture[str],
) -> None:
    plane = ("prove", "--system", "duffing")
    for typed in (plane, ("prove", "--every-hamiltonian"), (*EVERY[:-1], "1")):
        for scheme, known in (("lie2", False), ("stormer-verlet", True)):
            found = json_of(here(capsys, *typed, "--scheme", scheme, "--json")[1])
            assert (found["symplectic"], found["area_preserving"]) == (known, known)


def test_long_forms_are_named_and_not_written_out(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = here(capsys, *EVERY, "--scheme", "lie4", "--json")
    found = json_of(out)
    assert (status, found["leading"]) == (0, found["formula"])
    assert found["formula"].startswith("−1/5! Σ_i (d(X^5 p_i)∧dq_i")
    assert found["why"].startswith("β = −1/5! Σ_k")


@pytest.mark.parametrize(
    ("typed", "status", "said"),
    [
        ((*ONE, "--scheme", OWN), 1, "REFUTED: p1_next = p1; "),
        ((*ONE, "--scheme", "p_next = p; q_next = q"), 2, "H needs p1_next, p2_next"),
        ((*EVERY[:-1], "65", "--scheme", "lie2"), 2, "--degrees=65: must be 1 … 64"),
        ((*EVERY[:-1], "20", "--scheme", "lie2"), 2, "derivatives of H would be needed"),
        ((*EVERY[:-1], "x", "--scheme", "lie2"), 2, "--degrees=x"),
        ((*ONE, "--degrees", "2", "--scheme", "lie2"), 2, "--degrees: goes with --every"),
    ],
)  # fmt: skip
def test_what_is_refused(
    capsys: pytest.CaptureFixture[str], typed: tuple[str, ...], status: int, said: str
) -> None:
    found, out, err = here(capsys, *typed)
    assert (found, said in out + err) == (status, True)
    assert status < 2 or err.count("\n") == 1


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ((*ONE, "--scheme", "lie2"), "for this H and this map"),
        ((*ONE, "--scheme", "stormer-verlet"), "= 0 for every smooth H = T(p) + V(q) in 2"),
        ((*EVERY, "--scheme", "lie2"), "every smooth H in 2 degrees of freedom"),
    ],
)
def test_certificates_are_written_and_checked(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, typed: tuple[str, ...], said: str
) -> None:
    path = str(tmp_path / "c.json")
    assert here(capsys, *typed, "--certificate", path)[0] == 0
    status, out, _ = here(capsys, "certificate", "check", path)
    assert (status, said in out) == (0, True)
    found = json_of(here(capsys, "certificate", "check", path, "--json")[1])
    assert (found["accepted"], found["degrees"]) == (True, 2)


def test_from_python() -> None:
    found = verify.prove(HENON, "lie2")
    assert repr(found) == (
        "Proof(PROVED: the coefficients of S below h^3 vanish identically, that of h^3 does not)"
    )
