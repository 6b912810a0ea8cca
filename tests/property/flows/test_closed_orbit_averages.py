"""Closed orbits with a known solution: oscillators, pendulums and what never comes back.

Oscillators a p²/2 + b q²/2, shifted and scaled, turn with √(ab); the period of a pendulum is an
elliptic integral, by mpmath. What the flow does between is held against mpmath's cosine.
"""

import math
from fractions import Fraction

import mpmath
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.oscillators import digits_of, element, mpf, numbers, oscillator, rates, turned
from verify.flows.closed_orbit import closed_orbit, is_equilibrium, shifts
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit_average import average, bounded_part
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

few = drawn(8)


@few
@given(rates, rates, numbers, numbers, numbers, digits_of, st.integers(1, 20))
def test_an_oscillators_orbit_has_its_period_and_lies_where_cosines_lie(
    a: int, b: int, q0: Fraction, p: Fraction, q: Fraction, digits: int, count: int
) -> None:
    assume(p or q != q0)
    orbit = closed_orbit(oscillator(a, b, q0), (p, q), digits, count)
    assert (orbit.kind, len(orbit.points)) == ("libration", count)
    assert not any(orbit.shift)
    with mpmath.workdps(digits + 30):
        near = mpmath.mpf(10) ** -(digits - 2)
        period = 2 * mpmath.pi / mpmath.sqrt(a * b)
        assert abs(mpf(orbit.period) / period - 1) < near
        size = abs(mpf(p)) + abs(mpf(q - q0)) + 1
        for points in (orbit.points, orbit.finer().points):
            for k, (y, x) in enumerate(points):
                true = turned(a, b, mpf(p), mpf(q - q0), period * k / len(points))
                assert abs(mpf(y) - true[0]) + abs(mpf(x) - mpf(q0) - true[1]) < near * size * 8
        assert len(orbit.finer().points) == 2 * count
        found = orbit.values(element("p + 3*q"))
        assert all(
            abs(mpf(v) - mpf(y) - 3 * mpf(x)) < near * size * 8
            for v, (y, x) in zip(found, orbit.points, strict=True)
        )
        assert abs(mpf(orbit.time(Fraction(1, 3))) - period / 3) < near


@few
@given(st.integers(1, 4), st.integers(1, 3), st.integers(-6, 6), st.booleans(), st.booleans())
def test_a_pendulum_swings_or_goes_round_in_the_time_of_an_elliptic_integral(
    rate: int, size: int, at: int, over: bool, back: bool
) -> None:
    """p²/2 − s cos(r q) from q = 0: with p² > 4 s it goes round."""
    p = 2 * mpmath.sqrt(size) * (1 + mpmath.mpf(abs(at) + 2) / 9 * (1 if over else -1) / 2)
    start = Fraction(round(float(p) * 64), 64) * (-1 if back else 1)
    hamiltonian = Hamiltonian.parse(f"p**2/2 - {size}*cos({rate}*q)")
    orbit = closed_orbit(hamiltonian, (start, Fraction(0)), 20, 4)
    assert orbit.kind == ("rotation" if abs(start) ** 2 > 4 * size else "libration")
    with mpmath.workdps(40):
        k2 = mpf(start) ** 2 / (4 * size)
        whole = mpmath.ellipk(1 / k2) / mpmath.sqrt(k2) / 2 if over else mpmath.ellipk(k2)
        true = 4 * whole / (rate * mpmath.sqrt(size))
        assert abs(mpf(orbit.period) / true - 1) < mpmath.mpf(10) ** -18
        turn = 2 * mpmath.pi / rate * (-1 if back else 1) if over else 0
        assert abs(mpf(orbit.shift[1]) - turn) < mpmath.mpf(10) ** -18
        assert orbit.shift[0] == 0


@few
@given(st.integers(1, 9), st.integers(1, 3), st.booleans(), st.integers(8, 20))
def test_an_orbit_near_a_separatrix_has_its_period_but_for_the_digits_lost_there(
    near: int, rate: int, over: bool, digits: int
) -> None:
    """p²/2 − cos(r q) from q = 0 with p = 2 ± 10^−k: near the saddle k digits are lost."""
    p = 2 + Fraction(1 if over else -1, 10**near)
    hamiltonian = Hamiltonian.parse(f"p**2/2 - cos({rate}*q)")
    orbit = closed_orbit(hamiltonian, (p, Fraction(0)), digits, 2)
    assert orbit.kind == ("rotation" if over else "libration")
    with mpmath.workdps(60):
        k2 = mpf(p) ** 2 / 4
        whole = mpmath.ellipk(1 / k2) / mpmath.sqrt(k2) / 2 if over else mpmath.ellipk(k2)
        true = 4 * whole / rate
        assert abs(mpf(orbit.period) / true - 1) < mpmath.mpf(10) ** (near - digits - 2)
        far = max(abs(float(x) - y) for z in orbit.points for x, y in zip(z, (p, 0), strict=True))
        assert far < 20
    if near % 2:  # it takes long
        return
    try:
        found = average(hamiltonian, element("p**2"), (p, Fraction(0)), near)
    except NoFlowError:
        assert near > 3
        return
    assert found.period is not None
    period, bound = found.period
    with mpmath.workdps(60):
        assert abs(mpf(period) - true) <= mpf(bound) * 10 + true * mpmath.mpf(10) ** -12
        assert bound <= period / 10**near


PERIODIC = [
    ("cos(2*q) + p**2", {"q": "1"}),
    ("sin(q/3) + p**2", {"q": "6"}),
    ("cos(2*q/3)*sin(q/2) + p", {"q": "12"}),
    ("cos(p)*cos(q)", {"p": "2", "q": "2"}),
    ("cos(q) + q + p**2", {}),
    ("sin(3*q + p) + p**4", {"q": "2/3"}),
    ("p**2 + q**2", {}),
    ("tan(q)**2*0 + cos(4*q) + cos(6*q)", {"q": "1"}),
    ("cos(p) + q**2", {"p": "2"}),
    ("cos(pi*q) + p**2", {}),
    ("cos(p*q)", {}),
    ("cos(q**2) + p", {}),
    ("exp(sin(q)) + p**2", {"q": "2"}),
]


@pytest.mark.parametrize(("text", "periods"), PERIODIC)
def test_the_shifts_are_the_periods_that_algebra_shows(text: str, periods: dict[str, str]) -> None:
    """In units of 2π, half of which is what is written here."""
    found = list(shifts(Hamiltonian.parse(text)))
    wanted = [(Fraction(0), Fraction(0))]
    for name in ("p", "q"):
        if name in periods:
            size = Fraction(periods[name]) / 2
            wanted += [(s, Fraction(0)) if name == "p" else (Fraction(0), s) for s in (size, -size)]
    assert found == wanted


@few
@given(st.integers(1, 9), st.integers(1, 10), st.booleans())
def test_an_orbit_that_goes_ten_thousand_times_as_far_is_not_awaited(
    size: int, power: int, sign: bool
) -> None:
    """p²/2 + b q²/2 from p = ±1, q = 0 goes as far as b^(−½)."""
    rate = Fraction(size, 10**power)
    start = Fraction(1 if sign else -1), Fraction(0)
    hamiltonian = Hamiltonian.parse(f"p**2/2 + ({rate})*q**2/2")
    if 1 / rate > 4 * 10**8:  # 10⁴ times 1 + |z₀|, squared
        with pytest.raises(NoFlowError, match="goes far away"):
            closed_orbit(hamiltonian, start, 10, 1)
        return
    orbit = closed_orbit(hamiltonian, start, 10, 1)
    assert math.isclose(float(orbit.period), 2 * math.pi / math.sqrt(rate), rel_tol=1e-9)


LEAVING: list[tuple[str, str, str]] = [
    ("p**2/2 - q**2/2", "0", "1"),
    ("p**2/2", "1", "0"),
    ("p**2/2 - q**4/4", "0", "1"),
    ("p*q", "1", "1"),
    ("p**2/2 + q**3/3", "0", "-1"),
    ("p**2/2 + exp(-q)", "0", "0"),
    ("p**2/2 - cos(q)", "2", "0"),
    ("p**2/2 + q**2/2 - q**3/3", "0", "-1/2"),
    ("p**2/2 + log(q)", "0", "1"),
    ("p**2/2 - sqrt(1 - q)", "-1", "0"),
]


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("text", "p", "q"), LEAVING)
def test_what_leaves_or_lies_on_a_separatrix_is_not_closed(text: str, p: str, q: str) -> None:
    with pytest.raises(NoFlowError):
        closed_orbit(Hamiltonian.parse(text), (Fraction(p), Fraction(q)), 12, 4)


@few
@given(numbers, numbers, st.integers(-3, 3), st.sampled_from([Fraction(0), Fraction(1, 10**12)]))
def test_an_equilibrium_is_one_by_algebra_however_near_another_point_is(
    p: Fraction, q: Fraction, slope: int, beside: Fraction
) -> None:
    text = f"(p - ({p}))**2/2 + (q - ({q}))**2 + ({slope})*(q - ({q}))**3 + cos(p - ({p}))"
    hamiltonian = Hamiltonian.parse(text)
    field, _ = canonical_field(hamiltonian)
    assert is_equilibrium(hamiltonian, field, (p, q + beside)) == (beside == 0)
    assert not is_equilibrium(hamiltonian, field, (p + 1, q))
    if beside == 0:
        orbit = closed_orbit(hamiltonian, (p, q), 15, 8)
        assert (orbit.kind, orbit.period, len(orbit.points)) == ("equilibrium", None, 1)
        assert [
            Fraction(*x.as_integer_ratio()).limit_denominator(1000) for x in orbit.points[0]
        ] == [p, q]
        assert not any(orbit.shift)
        found = average(hamiltonian, element("p**2 + 3*q"), (p, q), 15)
        assert abs(found.value - (p**2 + 3 * q)) <= found.bound < Fraction(1, 10**15)
        assert found.period is None
        assert bounded_part(found)(orbit.points[0]) == 0
        with pytest.raises(NoFlowError, match="not defined"):
            average(hamiltonian, element(f"1/(q - ({q}))"), (p, q), 15)


def test_where_h_is_not_defined_there_is_no_orbit() -> None:
    for text in ("p**2/2 + log(q)", "p**2/2 + 1/q", "p**2 + sqrt(q - 1)"):
        hamiltonian = Hamiltonian.parse(text)
        with pytest.raises(NoFlowError, match="not defined"):
            closed_orbit(hamiltonian, (Fraction(0), Fraction(0)), 12, 4)
