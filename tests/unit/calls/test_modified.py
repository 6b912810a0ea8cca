"""`verify.modified_hamiltonian`: what it takes, and what it says of mistakes."""

import pytest

import verify
from verify import Hamiltonian, InputError, Verdict
from verify.schemes import get

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})


def test_it_takes_names_and_objects() -> None:
    known = verify.modified_hamiltonian("stormer-verlet", DUFFING, 2)
    verlet = get("stormer-verlet")
    for found in (
        verify.modified_hamiltonian("verlet", "duffing", 2, parameters={"delta": 1}),
        verify.modified_hamiltonian(verlet, DUFFING, 2),
        verify.modified_hamiltonian(verlet.step_map(DUFFING), DUFFING, 2),
        verify.modified_hamiltonian(verlet.step_map(DUFFING), order=2),
    ):
        assert (found.verdict, found.text) == (Verdict.PROVED, known.text)
    assert verify.modified_hamiltonian(verlet, order=2).text.startswith("H + h**2*")


def test_it_shows_itself() -> None:
    found = verify.modified_hamiltonian("stormer-verlet", DUFFING, 2)
    assert repr(found) == "ModifiedEquation(PROVED: every term up to h^2 is Hamiltonian)"
    assert "<td" in found._repr_html_()
    assert r"\tilde H &= " in found._repr_latex_()
    assert verify.modified_hamiltonian("lie2", order=2)._repr_latex_() == ""
    with pytest.raises(InputError, match="is no single H"):
        _ = verify.modified_hamiltonian("lie2", order=2).expression


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ({"scheme": "duffing", "system": "lie2"}, r"_hamiltonian\('lie2', 'duffing'\)"),
        ({"scheme": "duffing"}, r"write modified_hamiltonian\('stormer-verlet', 'duffing'\)"),
        ({"scheme": "lie2", "system": "duffing", "order": 0}, "order=0: must be a whole number"),
        ({"scheme": "lie2", "order": 9}, "order=9: must be a whole number, 1 … 8"),
        ({"scheme": "lie2", "parameters": {"delta": 1}}, "goes with a system"),
        ({"scheme": "lie2", "system": "duffing", "separable": True}, "goes without a system"),
        ({"scheme": "lie2", "system": "dufing"}, "is duffing meant"),
        ({"scheme": "stormer-verlet", "system": "twist"}, "explicit only"),
        ({"scheme": "p_next = p - h*q; q_next = q + h*p"}, "is given for one H"),
    ],
)  # fmt: skip
def test_a_mistake_is_told_in_one_line(given, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        verify.modified_hamiltonian(**given)
