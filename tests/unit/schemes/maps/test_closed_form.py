"""S of a map that is written in closed form: all its powers of h, the last ones too."""

import pytest

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.maps.step_map import StepMap

COUPLED = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1*q2**2"


def written(formulas: str) -> StepMap:
    return get(formulas).step_map(Hamiltonian.parse(COUPLED))


@pytest.mark.parametrize("power", [1, 2, 3])
@pytest.mark.parametrize(("one", "other"), [("p1", "q1"), ("p2", "q2"), ("p1", "q2")])
def test_a_defect_in_the_highest_power_of_h_alone_is_one(power: int, one: str, other: str) -> None:
    """x' = x + hⁿ y², y' = y + hⁿ x² have ∂(x', y')/∂(x, y) = 1 − 4 x y h²ⁿ; of p1 and q2, that are
    no pair, dp1∧dq1 and dp2∧dq2 have terms of hⁿ."""
    still = "; ".join(f"{n}_next = {n}" for n in ("p1", "p2", "q1", "q2") if n not in (one, other))
    step = written(
        f"{one}_next = {one} + h**{power}*{other}**2; "
        f"{other}_next = {other} + h**{power}*{one}**2; {still}"
    )
    found = step.flat
    assert not found.symplectic
    assert found.forms is not None
    powers = {2 * power} if one[1] == other[1] else {power}
    assert set(found.forms) == powers
    if one[1] == other[1]:
        (entry,) = found.forms[2 * power].entries.values()
        assert step.ring.text(entry).replace(" ", "") in (f"-4*{one}*{other}", f"-4*{other}*{one}")


@pytest.mark.parametrize(
    "formulas",
    [
        "lie1", "lie2",
        "p1_next = p1 + h**2*q2*p1; p2_next = p2 - h*q1; q1_next = q1 + h**3*p2**2; q2_next = q2",
    ],
)  # fmt: skip
def test_the_powers_of_h_add_up_to_what_is_made_at_once(formulas: str) -> None:
    step = written(formulas)
    ring, found = step.ring, step.flat
    assert found.forms
    whole = found.defect.entries
    h, total = ring.variable("h"), dict.fromkeys(whole, ring.zero)
    for power, form in found.forms.items():
        for place, x in form.entries.items():
            total[place] = total.get(place, ring.zero) + x * h**power
    assert all(ring.vanishes(total[place] - whole.get(place, ring.zero)) for place in total)
