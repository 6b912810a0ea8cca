"""Jacobi's and Weierstrass's functions in balls: against mpmath's, and their own equations."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import mpmath
import pytest
from flint import acb, arb, fmpq

from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians import systems
from verify.hamiltonians.elliptic import Weierstrass, jacobi, waves

BITS = 1000


def real(x: Any) -> Any:
    mantissa, exponent = x.mid().man_exp()
    return mpmath.ldexp(int(mantissa), int(exponent))


def parameters() -> Iterator[fmpq]:
    for k in (1, 3, 20, 60):
        yield fmpq(1, 3 * 10**k)
        yield 1 - fmpq(1, 3 * 10**k)


@pytest.mark.parametrize("u", [fmpq(1, 1000), fmpq(37, 3), fmpq(-5, 2), fmpq(1000)])
def test_jacobis_functions_are_those_of_mpmath(u: fmpq) -> None:
    with mpmath.workdps(150), working_precision(BITS):
        for m in parameters():
            ours = jacobi(arb(m))(arb(u))
            x, k = mpmath.mpf(int(u.p)) / int(u.q), mpmath.mpf(int(m.p)) / int(m.q)
            theirs = [mpmath.ellipfun(name, x, m=k) for name in ("sn", "cn", "dn")]
            for a, b in zip(ours, theirs, strict=True):
                assert abs(real(a) - b) < mpmath.mpf(10) ** -80
                assert a.rad() < arb(10) ** -80


@pytest.mark.parametrize("m", [fmpq(1, 2), fmpq(3, 2), fmpq(100), fmpq(1)])
def test_jacobis_functions_obey_their_equations_also_beyond_the_modulus_1(m: fmpq) -> None:
    with working_precision(BITS):
        t, step = arb(7) / 5, arb(10) ** -30
        sn, cn, dn = jacobi(m)(t)
        for of_one in (sn**2 + cn**2, m * sn**2 + dn**2):
            assert of_one.contains(1)
            assert of_one.rad() < 1e-200
        ahead, back = (jacobi(m)(t + x)[0] for x in (step, -step))
        assert abs((ahead - back) / (2 * step) - cn * dn) < arb(10) ** -55


def test_a_modulus_that_is_not_known_to_be_below_1_gives_nothing() -> None:
    assert not any(x.is_finite() for x in jacobi(arb(1, 1e-20))(arb(1)))
    assert not any(x.is_finite() for x in waves(arb(0, 1e-20), arb(1)))
    assert all(x.is_finite() for x in waves(arb(0), arb(1)))


INVARIANTS = [(1, 0), (1, 1), (-1, 1), (4, -1), (0, 1), (0, -2), (12, 8), (12, -8), (0, 0), (3, -1)]


def made(g2: int, g3: int) -> Weierstrass:
    return Weierstrass.from_invariants(fmpq(g2), fmpq(g3), fmpq(g2**3 - 27 * g3**2))


@pytest.mark.parametrize(("g2", "g3"), INVARIANTS)
def test_the_roots_are_those_of_the_cubic_in_their_order(g2: int, g3: int) -> None:
    with working_precision(BITS):
        w = made(g2, g3)
        pair = w.others
        roots = w.first, *((pair, pair.conjugate()) if isinstance(pair, acb) else pair)
        for e in roots:
            defect = 4 * e**3 - g2 * e - g3
            assert abs(defect) < arb(10) ** -200
        if not isinstance(pair, acb):
            assert roots[0] >= roots[1] >= roots[2]
        assert abs(sum(roots, arb(0))) < arb(10) ** -200


@pytest.mark.parametrize(("g2", "g3"), [x for x in INVARIANTS if x[0] ** 3 != 27 * x[1] ** 2])
def test_weierstrasss_function_obeys_its_equations_and_inverts(g2: int, g3: int) -> None:
    with working_precision(BITS):
        w = made(g2, g3)
        half = w.half_period()
        for part, side in ((fmpq(1, 7), -1), (fmpq(9, 10), -1), (fmpq(3, 2), 1)):
            x, y = w.values(half * part)
            assert (y**2 - (4 * x**3 - g2 * x - g3)).contains(0)
            assert y > 0 if side > 0 else y < 0
            assert w.inverse(x, side).overlaps(half * part)
            assert not w.inverse(x, -side).overlaps(half * part), "the control"
        assert not w.values(arb(0))[0].is_finite(), "a pole"


@pytest.mark.parametrize(
    ("name", "values", "start"),
    [
        ("duffing", {"delta": Fraction(1)}, (Fraction(1, 3), Fraction(3, 2))),
        ("double-well", {"b": Fraction(1)}, (Fraction(0), Fraction(1, 2))),
        ("pendulum", {}, (Fraction(1, 2), Fraction(1))),
        ("pendulum", {}, (Fraction(3), Fraction(1))),
    ],
)
def test_what_is_kept_of_a_motion_belongs_to_one_precision(
    name: str, values: dict[str, Fraction], start: tuple[Fraction, Fraction]
) -> None:
    """Each precision has its own; what another one found first changes nothing."""
    flow = systems.get(name).flow
    assert flow is not None
    motion, time = flow(values, *start), arb(7) / 4
    assert motion is not None
    found = {}
    for bits in (60, 400, 200, 60):
        with working_precision(bits):
            state = motion.state(time)
            assert max(x.rad() for x in state) < arb(2) ** (30 - bits)
            alone = flow(values, *start)
            assert alone is not None
            assert [str(x) for x in alone.state(time)] == [str(x) for x in state]
        found[bits] = state
    assert all(x.overlaps(y) for x, y in zip(found[60], found[400], strict=True))
