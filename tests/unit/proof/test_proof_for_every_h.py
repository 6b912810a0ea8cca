"""What a proof for every H is told by: its leading coefficient, its H, and its argument."""

import pytest

from verify.proof import proof_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.proof_for_every_h import STEPS
from verify.prose import read_prose


@pytest.mark.parametrize(("scheme", "has_formula"), [("lie2", True), ("rk4", False)])
def test_a_leading_form_of_too_many_terms_is_told_by_its_formula_where_it_has_one(
    scheme: str, has_formula: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    form = prove_for_every_h(scheme, degrees=2).form
    assert form is not None
    for most in (form.length, form.length - 1):
        monkeypatch.setattr(proof_for_every_h, "MOST_TERMS", most)
        found = prove_for_every_h(scheme, degrees=2)
        assert bool(found.formula) is has_formula
        long = has_formula and most < form.length
        assert found.leading == (found.formula if long else form.text)


@pytest.mark.parametrize(
    ("scheme", "degrees", "timed", "quantifier"),
    [
        ("lie1", 1, False, "every smooth H"),
        ("lie1", 1, True, "every smooth H(p, q, t)"),
        ("lie1", 2, False, "every smooth H(p, q) in 2 degrees of freedom"),
        ("stormer-verlet", 1, True, "every smooth H = T(p, t) + V(q, t)"),
        ("stormer-verlet", 3, True, "every smooth H = T(p, t) + V(q, t) in 3 degrees of freedom"),
    ],
)
def test_for_which_h_it_is_said(scheme: str, degrees: int, timed: bool, quantifier: str) -> None:
    assert prove_for_every_h(scheme, degrees=degrees, timed=timed).quantifier == quantifier


def test_the_argument_for_every_eta_is_told_whole_and_of_taylors_schemes_in_the_plane_alone() -> (
    None
):
    told = str(prove_for_every_h("lie2").argument)
    assert told.startswith("The exact flow has det 1: the coefficients of h, h², … in the ")
    assert told.endswith(" there, η = 2j + 1. ∎")
    assert told.count("∎") == 1
    places = [told.find(str(read_prose(text))) for text, _ in STEPS]
    assert places == sorted(places)
    assert places[0] == 0
    others = (
        prove_for_every_h("rk4"),
        prove_for_every_h("lie2", timed=True),
        prove_for_every_h("lie2", degrees=2),
    )
    assert not any(str(proof.argument) for proof in others)
