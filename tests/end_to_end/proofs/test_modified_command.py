"""`verify modified`: its JSON, its text and its exit status."""

import pytest

from tests.end_to_end.test_command_line import here, json_of

OWN = "p_next = p - h*sin(q); q_next = q + h*p_next"


def test_the_terms_and_the_energy_that_is_kept(capsys: pytest.CaptureFixture[str]) -> None:
    options = ("modified", "--system", "pendulum", "--scheme", OWN, "--order", "2")
    status, out, _ = here(capsys, *options, "--json")
    found = json_of(out)
    assert (status, found["verdict"], found["known_to"]) == (0, "PROVED", 2)
    assert [t["power"] for t in found["terms"]] == [0, 1, 2]
    assert found["terms"][1]["hamiltonian"] == "-p*sin(q)/2"
    assert found["terms"][1]["field"] == {"p": "p*cos(q)/2", "q": "-sin(q)/2"}
    assert (found["first_not_hamiltonian"], found["divergence_is_leading_delta_j"]) == (None, True)
    assert found["modified_hamiltonian"] in here(capsys, *options)[1]


def test_a_term_that_is_not_hamiltonian_ends_it(capsys: pytest.CaptureFixture[str]) -> None:
    options = ("modified", "--every-hamiltonian", "--separable", "--scheme", "rk4", "--order", "5")
    status, out, _ = here(capsys, *options, "--json")
    found = json_of(out)
    assert (status, found["verdict"], found["first_not_hamiltonian"]) == (0, "PROVED", 4)
    assert found["terms"][4]["hamiltonian"] is None
    assert found["terms"][4]["divergence"] != "0"
    assert found["hamiltonian"] == "every smooth H = T(p) + V(q)"
    out = here(capsys, *options)[1]
    assert "to h^3 only" in out
    assert "h^5 times that divergence" in out


@pytest.mark.parametrize(
    ("options", "status", "said"),
    [
        (("--system", "pendulum", "--scheme", "p_next = p; q_next = q"), 1, "REFUTED: not a"),
        (("--system", "pendulum", "--scheme", "verlet", "--order", "11"), 2, "--order=11: must be"),
        (("--every-hamiltonian", "--system", "twist", "--scheme", "lie2"), 2, "goes without"),
        (("--system", "pendulum", "--separable", "--scheme", "lie2"), 2, "--separable: goes with"),
    ],
)  # fmt: skip
def test_what_is_refused(
    capsys: pytest.CaptureFixture[str], options: tuple[str, ...], status: int, said: str
) -> None:
    found, out, err = here(capsys, "modified", *options)
    assert (found, said in out + err) == (status, True)
