"""What follows from conditions on coefficients, and which schemes are symmetric."""

from dataclasses import replace
from fractions import Fraction

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.constructed.schemes import Made, conditions
from tests.helpers.maps import by_formulas
from tests.helpers.sampled.formulas import polynomials, rationals
from tests.helpers.symmetry import palindromic, prove_symmetry
from verify.algebra.embedding import embed
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.map_symmetry import judge_symmetry
from verify.proof.order_conditions import prove_by_conditions
from verify.schemes import get
from verify.schemes.conditions.condition import decimal_of
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.verdict import Verdict

quick = drawn(25)

# -- verdicts -------------------------------------------------------------------------------------


@drawn(100)
@given(conditions, st.integers(1, 4))
def test_the_order_is_the_last_up_to_which_all_hold_and_the_verdict_says_what_is_known(
    generic: Made, claimed: int
) -> None:
    scheme = replace(get("euler"), name="drawn", order=claimed)
    proof = prove_by_conditions(scheme, generic)
    most = min(claimed + 2, generic.most_order)
    bad = [n for n, holds in generic.of_order if holds is not True and n <= most]
    order = min(bad, default=most + 1) - 1
    assert proof.convergence_order == order
    assert (proof.scheme, proof.separable, proof.order) == ("drawn", generic.separable, None)
    asked = [holds for n, holds in generic.of_order if n <= claimed]
    area = generic.of_area
    preserved = bool(area) and all(area)
    assert proof.area_preserving is (True if preserved else None)
    assert proof.conditions == (*generic.order_conditions(claimed), *generic.area_conditions())
    if False in asked:
        first = min(n for n, holds in generic.of_order if holds is False)
        wanted, said = Verdict.REFUTED, f"claims order {claimed}; of h^{first},"
    elif None in asked:
        wanted, said = Verdict.UNDECIDED, "is not decided"
    elif area and not all(area):
        wanted, said = Verdict.UNDECIDED, f"order {claimed} is proved"
    else:
        wanted, said = Verdict.PROVED, f"order {claimed}"
    assert proof.verdict is wanted
    assert said in proof.reason
    count = sum(n <= order for n, _ in generic.of_order)
    word = "1 condition on" if count == 1 else f"{count} conditions on"
    assert proof.checked[0] == f"order {order}, {word} the coefficients"
    assert len(proof.checked) == 1 + (order < most)
    if order < most:
        here = [holds for n, holds in generic.of_order if n == order + 1]
        assert f"of h^{order + 1}," in proof.checked[1]
        assert ("does not hold" in proof.checked[1]) == (False in here)


@quick
@given(rationals(), st.integers(-2000, 2000) | st.sampled_from([-(10**6), -200_000, 200_000]))
def test_a_residue_is_a_decimal_of_twelve_digits_where_it_is_in_reach(
    x: Fraction, power: int
) -> None:
    ring, _ = embed([sympy.S.One], ())
    number = x * Fraction(2) ** power
    shown = decimal_of(ring, ring.constant(number), 12)
    if abs(power) > 10**5:
        assert shown == "unknown"
    else:
        assert abs(Fraction(shown) - number) <= abs(number) / 10**11
        assert abs(number) >= abs(Fraction(shown)) * (1 - Fraction(1, 10**10)) > 0


# -- symmetry -------------------------------------------------------------------------------------

shares = st.sampled_from([Fraction(x) for x in ("0", "1/2", "1", "1/3", "2/3")])
lengths = st.sampled_from([Fraction(x) for x in ("1", "1/2", "1/3", "-1")])
stages = st.builds(Stage, lengths, lengths, shares, shares)


def undoing(rows: tuple[Stage, ...]) -> tuple[Stage, ...]:
    return tuple(Stage(s.kick, s.drift, 1 - s.at_p, 1 - s.at_q) for s in reversed(rows))


@quick
@given(st.lists(stages, min_size=1, max_size=2).map(tuple), st.booleans())
def test_stages_are_symmetric_where_the_undoing_ones_in_reverse_are_the_same(
    rows: tuple[Stage, ...], doubled: bool
) -> None:
    rows = rows + undoing(rows) if doubled else rows
    own = StageEquations(rows)
    assert palindromic(own) == (rows == undoing(rows))
    assert palindromic(own) or not doubled
    scheme = replace(get("implicit-midpoint"), every_h=own, order=1)
    if palindromic(own):
        assert prove_symmetry(scheme).verdict is Verdict.PROVED


@drawn(20)
@given(polynomials("q", degree=3, most_terms=2), rationals(3), st.integers(2, 5), st.integers(2, 6))
def test_the_first_power_of_h_that_a_step_back_leaves_is_found(
    force: str, size: Fraction, power: int, most: int
) -> None:
    """p' = p + c hⁿ F(q), q' = q: the step of −h takes it away for odd n, doubles it for even."""
    formulas = f"p + ({size})*h**{power}*({force})", "q + h*p**0*0"
    hamiltonian = Hamiltonian.parse("p**2/2 + q**2/2")
    step_map = by_formulas(hamiltonian, *formulas)
    found = judge_symmetry(step_map, most)
    if power % 2 == 0 and power <= most:
        assert (found.verdict, found.power) == (Verdict.REFUTED, power)
        assert f"O(h^{power})" in found.reason
    else:
        assert (found.verdict, found.power) == (Verdict.UNDECIDED, None)
        assert f"up to h^{most} at least" in found.reason


@pytest.mark.parametrize(
    ("name", "power"),
    [
        ("lie1", 2),
        ("lie2", 4),
        ("lie3", 4),
        ("rk4", 6),
        ("explicit-midpoint", 4),
        ("symplectic-euler", 2),
        ("p_next = p; q_next = 2*q", None),
        ("p_next = p; q_next = q + h*p", None),
        ("p_next = p/(1 + h); q_next = q", None),
    ],
)
def test_a_scheme_without_conditions_is_judged_by_its_series(name: str, power: int | None) -> None:
    """An even power of h is the first: what the step of −h leaves is symmetric itself."""
    found = prove_symmetry(get(name))
    assert found.power == power
    assert (found.verdict is Verdict.REFUTED) == (power is not None)
    assert found.verdict is not Verdict.PROVED
