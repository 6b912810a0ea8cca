"""A sample of the campaign's claims, true and false, beside what mpmath says of them."""

from collections import Counter
from dataclasses import replace

import mpmath
import pytest
import sympy

from tests.campaigns.kept_claims import judged, prove
from tests.helpers.sampled.kept_claims import FAMILIES, kept_claim
from tests.helpers.stepping.kept_structures import (
    SCHEMES,
    Field,
    Kept,
    jacobian,
    leading_of,
    mp,
    order_of,
)
from verify.verdict import Verdict

SEED, EACH = 64, 3
p, q = sympy.symbols("p q")
PENDULUM = Field(("p", "q"), (-sympy.sin(q), p))
POINT = [mp.mpf("0.4"), mp.mpf("0.9")]


@pytest.mark.parametrize("family", range(len(FAMILIES)), ids=lambda k: FAMILIES[k].__name__)
def test_no_drawn_claim_is_judged_wrong_and_few_are_left_undecided(family: int) -> None:
    numbers = range(family, family + EACH * len(FAMILIES), len(FAMILIES))
    results = [judged(kept_claim(SEED, number)) for number in numbers]
    assert not [x.wrong for x in results if x.wrong]
    assert sum(x.undecided for x in results) <= 1


def test_claims_are_true_and_false_and_exact_ones_among_them() -> None:
    sorts = Counter[tuple[bool, bool]]()
    for number in range(20):
        claim = kept_claim(SEED, number)
        sorts[claim.drawn.of_flow, claim.claimed is None] += 1
    assert {True, False} <= {exact for _, exact in sorts}


def test_a_seed_draws_the_same_claims_again() -> None:
    assert kept_claim(SEED, 7).request == kept_claim(SEED, 7).request
    assert kept_claim(SEED, 7) != kept_claim(SEED, 17)


# -- the campaign sees what is wrong --------------------------------------------------------------


def test_a_wrong_verdict_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    claim = next(c for c in (kept_claim(SEED, k) for k in range(50))
                 if c.drawn.of_flow and c.order() is not None)  # fmt: skip
    claim = replace(claim, claimed=None)
    right = prove(claim)
    assert right is not None
    assert not judged(claim).wrong
    for planted in (
        replace(right, verdict=Verdict.PROVED),
        replace(right, first=replace(right.first, power=(right.order or 0) + 1)),
        None,
    ):
        monkeypatch.setattr("tests.campaigns.kept_claims.prove", lambda _, x=planted: x)
        assert judged(claim).wrong


def test_a_structure_that_is_none_but_taken_is_seen() -> None:
    claim = next(c for c in (kept_claim(SEED, k) for k in range(9, 100, 10))
                 if not c.drawn.of_flow)  # fmt: skip
    assert not judged(claim).wrong
    assert judged(replace(claim, drawn=replace(claim.drawn, of_flow=True))).wrong


# -- the oracle ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scheme", "energy", "area"),
    [("euler", 2, 2), ("lie2", 3, 3), ("lie3", 4, 4), ("rk4", 5, 6), ("stormer-verlet", 3, None),
     ("implicit-midpoint", 3, None), ("gauss4", 5, None), ("symplectic-euler", 2, None)],
)  # fmt: skip
def test_the_oracle_s_orders_are_the_textbook_s(scheme: str, energy: int, area: int | None) -> None:
    step = SCHEMES[scheme](PENDULUM)
    integral = Kept("integral", (p**2 / 2 - sympy.cos(q),))
    assert order_of(integral, ("p", "q"), step, POINT, mp.mpf(0)) == energy
    form = Kept("form", (sympy.Integer(1),), ((0, 1),))
    assert order_of(form, ("p", "q"), step, POINT, mp.mpf(0)) == area
    assert order_of(Kept("volume", (sympy.Integer(1),)), ("p", "q"), step, POINT, 0) == area


def test_the_oracle_s_leading_coefficient_is_that_of_a_hand() -> None:
    """ΔJ of Euler's step for the pendulum: h² cos q."""
    order, (x,) = leading_of(
        Kept("volume", (sympy.Integer(1),)), ("p", "q"), SCHEMES["euler"](PENDULUM), POINT, 0
    )
    assert order == 2
    assert abs(x - mp.cos(POINT[1])) < 1e-9


def test_the_oracle_s_jacobian_is_right_to_many_digits() -> None:
    j = jacobian(SCHEMES["euler"](PENDULUM), POINT, 0, mp.mpf("0.1"))
    expected = mpmath.matrix([[1, -mp.mpf("0.1") * mp.cos(POINT[1])], [mp.mpf("0.1"), 1]])
    assert max(abs(j[a, b] - expected[a, b]) for a in (0, 1) for b in (0, 1)) < mp.mpf(10) ** -150
