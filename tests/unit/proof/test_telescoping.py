"""What telescopes for every H, and what does not, by linear algebra and by the formula."""

from typing import Any

import pytest

from tests.helpers.lie_derivatives import along_flow
from verify.algebra.jets import Jets
from verify.exploration.properties.plane.order_by_jets import delta_j
from verify.hamiltonians.canonical_field import JetField
from verify.proof import series_for_every_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.telescoping import potential_of_lie, telescopes
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.steps.two_form import TwoForm


@pytest.mark.parametrize("eta", range(1, 8))
def test_linear_algebra_finds_what_the_formula_says(eta: int) -> None:
    jets = Jets(eta + 2)
    leading = list(delta_j(jets, *TaylorSeries(eta).taylor(jets, eta + 1)))[-1]
    found = telescopes(jets, leading)
    assert found.holds is (eta % 2 == 0)
    if found.holds:
        by_formula = potential_of_lie(JetField.from_jets(jets), eta).divergence
        assert along_flow(jets, found.potential) == leading == along_flow(jets, by_formula)


def test_one_coefficient_more_no_longer_telescopes() -> None:
    jets = Jets(5)
    leading = list(delta_j(jets, *TaylorSeries(2).taylor(jets, 3)))[-1]
    changed = leading + jets.h(1, 0) * jets.h(2, 0) * jets.h(0, 3)
    found = telescopes(jets, changed)
    assert not found.holds
    assert "dimension" in found.reason
    assert along_flow(jets, potential_of_lie(JetField.from_jets(jets), 2).divergence) != changed


def test_a_hidden_derivative_is_found() -> None:
    jets = Jets(6)
    hidden = jets.h(2, 0) * jets.h(1, 2) ** 2 - 3 * jets.h(0, 3) * jets.h(2, 1) * jets.h(2, 0)
    hidden += jets.h(1, 0) ** 2 * jets.h(0, 2)
    assert telescopes(jets, along_flow(jets, hidden)).holds


def test_odd_schemes_have_no_potential_formula() -> None:
    with pytest.raises(ValueError, match="odd"):
        potential_of_lie(JetField.from_jets(Jets(4)), 1)


@pytest.mark.parametrize(("degrees", "potential"), [(1, "-1/2*H_pq**2 + 1/2*H_pp*H_qq"), (2, None)])
def test_a_wrong_formula_for_the_potential_is_not_accepted(
    degrees: int, potential: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the plane linear algebra finds the right one all the same."""
    right = series_for_every_h.potential_of_lie

    def wrong(flow: Any, eta: int) -> TwoForm:
        form = right(flow, eta)
        return TwoForm.from_entries(
            form.ring, form.names, lambda a, b: form.entry(a, b) * (2 - (a == 1))
        )

    monkeypatch.setattr(series_for_every_h, "potential_of_lie", wrong)
    proof = prove_for_every_h("lie2", degrees=degrees)
    assert (proof.telescopes, proof.potential) == (True if potential else None, potential)
    assert not any("is that coefficient" in str(line) for line in proof.checked)
