"""Separations of drawn runs: the digits asked for, and bounds that hold.

The oracle is in rationals (`tests.helpers.stepping.exact_separation`), or has more digits.
"""

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.separations import (
    DUFFING,
    FIXED,
    KNOWN,
    SHORT,
    area_chains,
    bent,
    only,
    separated,
    sizes,
    starts,
    step_sizes,
)
from tests.helpers.stepping.exact_separation import links
from verify import arithmetic as number_systems
from verify.arithmetic.number_system import Arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.studies.separation.chain import QUANTITIES, Chain, Link
from verify.studies.separation.determinants import WORKING, Determinants, _bound_product
from verify.studies.separation.mixed_run import MixedRun, Stopped
from verify.studies.separation.truncation_and_rounding import separate

few = drawn(10)
some = drawn(14)


# -- digits and bounds ----------------------------------------------------------------------------


# Beside a float64, so that the parts of rounding are smaller than what is foreseen.
beside = st.builds(
    lambda n, k: Fraction(n, 16) + Fraction(1, 10**k), st.integers(1, 16), st.integers(17, 60)
)


@some
@given(
    bent(),
    st.integers(1, 3),
    starts | beside,
    st.just(Fraction(3, 4)) | starts | beside,
    step_sizes | beside,
    st.integers(1, 5),
    st.integers(1, 60),
    st.sampled_from(["mpfr", "mpmath", "ball", "auto"]),
)
def test_every_part_is_known_to_the_digits_asked_for_and_within_its_bound(
    text: str, eta: int, p: Fraction, q: Fraction, h: Fraction, steps: int, digits: int, name: str
) -> None:
    start = {"p": p, "q": q, "h": h}
    found, advanced = separated(text, f"lie{eta}", start, steps, digits, name)
    true = links(text, eta, start, steps)
    for way in ("plain", "closed_form"):
        chain: Chain | None = getattr(found, way)
        if chain is None:
            continue
        exact = true[way]
        for k, link in enumerate(chain.links[:4]):
            assert abs(link.trail[-1] - exact[k]) <= link.bound + SHORT
        for part in QUANTITIES:
            value, bound = chain.final(part)
            # Two ends, each to a quarter of a last digit; what is 0 may stay unknown.
            assert bound <= abs(value) / 10**digits / 2 or abs(value) <= 2 * bound
        assert chain.lacking(digits) == [0] * 5 or any(
            abs(chain.final(part)[0]) <= 2 * chain.final(part)[1] for part in QUANTITIES
        )
    assert sum(advanced) <= 3 * steps
    assert found.seconds >= 0
    assert found.arithmetic in number_systems.names()
    assert name in ("auto", found.arithmetic)


@some
@given(st.sampled_from(KNOWN), st.integers(1, 4), starts, starts, step_sizes, st.integers(2, 300))
def test_bounds_of_few_bits_hold_against_many_at_every_checkpoint(
    text: str, eta: int, p: Fraction, q: Fraction, h: Fraction, steps: int
) -> None:
    run = KernelRun(
        Hamiltonian.parse(text), f"lie{eta}", {"p": p, "q": q, "h": h}, steps, WORKING, 10
    )
    working = MixedRun(Determinants(), run, follow=True)
    coarse_, fine_ = number_systems.get("mpfr", 17), number_systems.get("mpfr", 90)
    try:
        coarse, fine = (
            run_alone(working.step_through(x, lambda _: None)) for x in (coarse_, fine_)
        )
    except Stopped:
        assume(False)
        raise
    for name in ("trajectory", "factors", "closed_factors"):
        x, y = only(getattr(coarse, name)), only(getattr(fine, name))
        assert (x is None) == (y is None)
        if x is not None:
            apart = [abs(a - b) for a, b in zip(x.trail, y.trail, strict=True)]
            assert max(apart) <= x.bound + y.bound
            top = max(map(abs, x.trail))
            if x.bound:
                loose = 10**7 * steps * (top + 1) * 2**-coarse_.bits
                assert x.bound <= loose
            if top > Fraction(1, 2):
                assert (x.kind, "rerun" in x.method) == ("estimated", True)
    assert coarse.plain[0].trail == fine.plain[0].trail
    assert len(coarse.plain[0].trail) == len(working.marks) == steps
    assert coarse.plain[0].bound == 0


QUARTIC = "p**2/2 + q**2/2 + delta*q**4/4"
deltas = st.builds(Fraction, st.integers(1, 9), st.integers(1, 9))


def agree(one: Link, other: Link) -> None:
    for x, y in zip(one.trail, other.trail, strict=True):
        assert abs(x - y) <= one.bound + other.bound


@few
@given(deltas, starts, starts, step_sizes.map(lambda h: h / 8), st.integers(1, 400))
def test_fixed_point_beside_float64_is_within_its_bound(
    delta: Fraction, p: Fraction, q: Fraction, h: Fraction, steps: int
) -> None:
    hamiltonian = Hamiltonian.parse(QUARTIC, {"delta": delta})
    run = KernelRun(hamiltonian, "lie2", {"p": p, "q": q, "h": h}, steps, WORKING, 10)
    working = MixedRun(Determinants(), run, follow=True)
    coarse, fine = (
        run_alone(working.step_through(x, lambda _: None))
        for x in (FIXED, number_systems.get("mpfr", 90))
    )
    for name in ("trajectory", "factors", "closed_factors"):
        x, y = only(getattr(coarse, name)), only(getattr(fine, name))
        agree(x, y)
        if x.kind == "enclosed":
            assert 0 < x.bound <= 10**7 * steps * Fraction(1, 2**FIXED.bits)
    assert coarse.plain[0].trail == fine.plain[0].trail
    assert coarse.closed_form is not None
    assert fine.closed_form is not None
    assert coarse.closed_form[0].trail == fine.closed_form[0].trail


@some
@given(
    st.integers(1, 10**9),
    sizes,
    st.one_of(st.none(), st.just(Fraction(0)), sizes.map(lambda x: x / 10**9)),
    st.sampled_from([FIXED, number_systems.get("mpfr", 12)]),
)
def test_a_counted_bound_is_that_of_n_roundings_and_none_beyond_what_it_speaks_of(
    steps: int, top: Fraction, own: Fraction | None, made: Arithmetic
) -> None:
    """|ρ| ≤ 12 u M + 2 B, u = 2^(1 − bits), or three units and 2 B; 4 N |ρ| at most 1/100."""
    found = _bound_product(steps, top, own, made)
    if own is None or top > Fraction(1, 2):
        assert found is None
        return
    unit = Fraction(1, 2**made.bits)
    each = 3 * unit if made.absolute else 24 * unit * top
    most = 4 * steps * (each + 2 * own)
    assert found == (most if 100 * most <= 1 else None)


@pytest.mark.left_to_ci
@few
@given(
    st.sampled_from([Fraction(1), Fraction(7, 9)]),
    st.sampled_from(["1", "7", "200", "40000"]),
    st.integers(2, 30),
)
def test_what_fixed_point_cannot_follow_is_followed_by_mpfr(
    delta: Fraction, q: str, steps: int
) -> None:
    hamiltonian = Hamiltonian.parse(QUARTIC, {"delta": delta})
    at: dict[str, Any] = {"q": q, "p": 1, "step_size": "1/9", "steps": steps}
    one, other = (separate(hamiltonian, "lie2", **at, arithmetic=n) for n in ("fixed", "mpfr"))
    assert one.status == other.status
    if one.plain is None or other.plain is None:
        return
    for (name, x), (_, y) in zip(one.plain.parts, other.plain.parts, strict=True):
        both = Fraction(x.bound) + Fraction(y.bound)
        assert abs(Fraction(x.value) - Fraction(y.value)) <= both, name


@few
@given(starts, starts, st.integers(5, 60))
def test_a_large_lambda_is_estimated_and_a_small_one_counted(
    p: Fraction, q: Fraction, steps: int
) -> None:
    """p²/2 + q²/2 by lie1: 1 + ΔJ = 1 + h² at every step."""
    assume(p or q)
    for h in (Fraction(1, 3), Fraction(1, 300)):
        run = Hamiltonian.parse(DUFFING), "lie1", {"p": p, "q": q, "h": h}, steps
        try:
            plain = area_chains(*run, 17, "mpfr").plain
        except Stopped:
            continue
        middle = plain.links[3]
        large = max(map(abs, middle.trail)) > Fraction(1, 2)
        assert middle.kind == ("estimated" if large else "enclosed")
        assert ("rerun with 15 more digits" in middle.method) == large
        assert (plain.kind == "estimated") or not large
