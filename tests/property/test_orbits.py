"""Closed orbits with a known solution: oscillators, pendulums and what never comes back.

Oscillators a p²/2 + b q²/2, shifted and scaled, turn with √(ab); the period of a pendulum is an
elliptic integral, by mpmath. What the flow does between is held against mpmath's cosine.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.property.strategies import polynomials
from verify.formula import parse
from verify.generators import embed
from verify.hamiltonian import Hamiltonian
from verify.proof.closed_orbit import Element, Orbit, at_rest, closed_orbit, shifts
from verify.proof.exact_flow import Flow, NoFlowError, functions_at
from verify.proof.orbit_average import Average, average, bounded_part, phase

few = settings(deadline=None, max_examples=8)
numbers = st.builds(Fraction, st.integers(-12, 12), st.integers(4, 9))
rates = st.integers(1, 6)
digits_of = st.integers(8, 40)


def element(text: str) -> Element:
    ring, (x,) = embed([parse(text)], ("p", "q"))
    return ring, x


def mpf(x: Any) -> Any:
    if isinstance(x, Fraction):
        return mpmath.mpf(x.numerator) / x.denominator
    n, d = x.as_integer_ratio()
    return mpmath.mpf(int(n)) / int(d)


def oscillator(a: int, b: int, q0: Fraction) -> Hamiltonian:
    return Hamiltonian.parse(f"{a}*p**2/2 + {b}*(q - ({q0}))**2/2")


def turned(a: int, b: int, p: Any, q: Any, time: Any) -> tuple[Any, Any]:
    """p' = −b q, q' = a p."""
    rate = mpmath.sqrt(a * b)
    c, s = mpmath.cos(rate * time), mpmath.sin(rate * time)
    return p * c - q * s * b / rate, q * c + p * s * a / rate


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
        assert all(abs(mpf(v) - mpf(y) - 3 * mpf(x)) < near * size * 8 for v, (y, x) in zip(found, orbit.points, strict=True))  # fmt: skip
        assert abs(mpf(orbit.time(Fraction(1, 3))) - period / 3) < near


@few
@given(st.integers(1, 4), st.integers(1, 3), st.integers(-6, 6), st.booleans(), st.booleans())
def test_a_pendulum_swings_or_goes_round_in_the_time_of_an_elliptic_integral(
    rate: int, size: int, at: int, over: bool, back: bool
) -> None:
    """p²/2 − s cos(r q) from q = 0: with p² > 4 s it goes round."""
    p = (2 * mpmath.sqrt(size) * (1 + mpmath.mpf(abs(at) + 2) / 9 * (1 if over else -1) / 2))
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
    try:
        found = average(hamiltonian, element("p**2"), (p, Fraction(0)), 6)
    except NoFlowError:
        assert near > 3
        return
    assert found.period is not None
    period, bound = found.period
    with mpmath.workdps(60):
        assert abs(mpf(period) - true) <= mpf(bound) * 10 + true * mpmath.mpf(10) ** -12
        assert bound <= period / 10**6


PERIODIC = [
    ("cos(2*q) + p**2", {"q": "1"}), ("sin(q/3) + p**2", {"q": "6"}),
    ("cos(2*q/3)*sin(q/2) + p", {"q": "12"}), ("cos(p)*cos(q)", {"p": "2", "q": "2"}),
    ("cos(q) + q + p**2", {}), ("sin(3*q + p) + p**4", {"q": "2/3"}), ("p**2 + q**2", {}),
    ("tan(q)**2*0 + cos(4*q) + cos(6*q)", {"q": "1"}), ("cos(p) + q**2", {"p": "2"}),
    ("cos(pi*q) + p**2", {}), ("cos(p*q)", {}), ("cos(q**2) + p", {}), ("exp(sin(q)) + p**2", {"q": "2"}),
]  # fmt: skip


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


LEAVING: list[tuple[str, str, str]] = [
    ("p**2/2 - q**2/2", "0", "1"), ("p**2/2", "1", "0"), ("p**2/2 - q**4/4", "0", "1"),
    ("p*q", "1", "1"), ("p**2/2 + q**3/3", "0", "-1"), ("p**2/2 + exp(-q)", "0", "0"),
    ("p**2/2 - cos(q)", "2", "0"), ("p**2/2 + q**2/2 - q**3/3", "0", "-1/2"),
    ("p**2/2 + log(q)", "0", "1"), ("p**2/2 - sqrt(1 - q)", "-1", "0"),
]  # fmt: skip


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
    field, _ = hamiltonian.field()
    assert at_rest(hamiltonian, field, (p, q + beside)) == (beside == 0)
    assert not at_rest(hamiltonian, field, (p + 1, q))
    if beside == 0:
        orbit = closed_orbit(hamiltonian, (p, q), 15, 8)
        assert (orbit.kind, orbit.period, len(orbit.points)) == ("equilibrium", None, 1)
        assert [Fraction(*x.as_integer_ratio()).limit_denominator(1000) for x in orbit.points[0]] == [p, q]  # fmt: skip
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


# -- the flow -------------------------------------------------------------------------------------


@few
@given(rates, rates, numbers, numbers, st.integers(-40, 40), digits_of)
def test_the_flow_is_followed_for_any_time_forth_and_back(
    a: int, b: int, p: Fraction, q: Fraction, tenths: int, digits: int
) -> None:
    field, _ = oscillator(a, b, Fraction(0)).field()
    flow, time = Flow(field, digits), Fraction(tenths, 10)
    z = flow.number(p), flow.number(q)
    slope = flow.slope(z)
    end = flow.follow(z, time)
    small = flow.advance(z, flow.number(time / 20))
    one = flow.step(z, flow.number(time / 400))
    with mpmath.workdps(digits + 30):
        near = mpmath.mpf(10) ** -digits * (abs(mpf(p)) + abs(mpf(q)) + 1) * 40
        assert abs(mpf(slope[0]) + b * mpf(q)) + abs(mpf(slope[1]) - a * mpf(p)) < near
        for found, after in ((end, time), (small, time / 20), (one, time / 400)):
            assert found is not None
            true = turned(a, b, mpf(p), mpf(q), mpf(after))
            assert abs(mpf(found[0]) - true[0]) + abs(mpf(found[1]) - true[1]) < near
    again = flow.follow(end, -time)
    with mpmath.workdps(digits + 30):
        assert abs(mpf(again[0]) - mpf(p)) + abs(mpf(again[1]) - mpf(q)) < near
    if time:
        if a * b > 3 and (p or q):
            assert flow.step(z, flow.number(Fraction(1000))) is None, "too long for one step"
        with pytest.raises(NoFlowError, match="1 steps lead only"):
            flow.follow(z, 1000 * time, 1)


@pytest.mark.parametrize(
    ("text", "p", "q", "time", "said"),
    [("p**2/2 - q**4/4", "1", "1", "5", "at about t = "), ("p**2/2 + sqrt(q)", "0", "-1", "1", "leaves where H"),
     ("p**2/2 + log(q)", "0", "1", "5", "at about t = "), ("p**2/2 - q**4/4", "1", "1", "-9", "at about t = "),
     ("p**2/2 - q**4/4", "-1", "1", "-9", "at about t = -")],
)  # fmt: skip
def test_a_flow_that_ends_says_about_when(text: str, p: str, q: str, time: str, said: str) -> None:
    field, _ = Hamiltonian.parse(text).field()
    flow = Flow(field, 12)
    with pytest.raises(NoFlowError, match=said):
        flow.follow((flow.number(Fraction(p)), flow.number(Fraction(q))), Fraction(time))


@pytest.mark.parametrize(
    ("text", "p", "q", "time"),
    [("p**2/2 - q**4/4", "1", "1", "9"), ("p**2/2 + log(q)", "0", "1", "7"), ("p**2/2 - q**4/4", "-1", "1", "-9")],
)  # fmt: skip
def test_a_flow_is_not_advanced_beyond_its_end(text: str, p: str, q: str, time: str) -> None:
    flow = Flow(Hamiltonian.parse(text).field()[0], 8)
    start = flow.number(Fraction(p)), flow.number(Fraction(q))
    with pytest.raises(NoFlowError):
        flow.advance(start, flow.number(Fraction(time)), 7)


@few
@given(rates, numbers, numbers, st.integers(10, 30), st.sampled_from([-1, 1]))
def test_a_flow_is_followed_in_steps_as_long_as_its_accuracy_allows(
    b: int, p: Fraction, q: Fraction, digits: int, sign: int
) -> None:
    """By the longest that one step can be: most are a third of it at least, and few too long."""
    assume(p or q)
    flow = Flow(oscillator(1, b, Fraction(0)).field()[0], digits)
    z = flow.number(p), flow.number(q)
    longest = next(Fraction(n, 64) for n in range(1, 640) if flow.step(z, flow.number(Fraction(n, 64))) is None)  # fmt: skip
    tried: list[bool] = []
    one = flow.step

    def counted(*given: Any) -> Any:
        tried.append(one(*given) is not None)
        return one(*given)

    flow.step = counted  # type: ignore[method-assign]
    flow.follow(z, sign * 40 * longest)
    assert 40 <= tried.count(True) + 2
    assert tried.count(True) <= 75
    assert tried.count(False) <= tried.count(True) / 3 + 3


@few
@given(polynomials("pq", 3, 3), numbers, numbers)
def test_functions_at_a_point_are_what_they_are(text: str, p: Fraction, q: Fraction) -> None:
    field, _ = oscillator(1, 1, Fraction(0)).field()
    flow = Flow(field, 30)
    at = functions_at(flow.arithmetic, [element(text), element(f"cos(q)*({text})")])
    with flow.arithmetic.context():
        one, other = at(flow.number(p), flow.number(q))
    names = {n: sympy.Rational(str(x)) for n, x in (("p", p), ("q", q))}
    true = sympy.sympify(text, locals={n: sympy.Symbol(n) for n in "pq"}, rational=True).subs(names)
    with mpmath.workdps(40):
        value = mpmath.mpf(sympy.N(true, 40))
        assert abs(mpf(one) - value) <= abs(value) * mpmath.mpf(10) ** -28 + mpmath.mpf(10) ** -28
        assert abs(mpf(other) - value * mpmath.cos(mpf(q))) <= (1 + abs(value)) * mpmath.mpf(10) ** -28


# -- averages -------------------------------------------------------------------------------------

MEANS: list[tuple[str, Callable[[Fraction, Fraction], Fraction]]] = [
    ("q**2", lambda e, f: e / f), ("p**2", lambda e, f: e), ("q", lambda e, f: Fraction(0)),
    ("p*q + 5", lambda e, f: Fraction(5)), ("q**4", lambda e, f: Fraction(3, 2) * e * e / f / f),
    ("3*p**2*q**2 + q**3", lambda e, f: Fraction(3, 2) * e * e / f),
]  # fmt: skip


@few
@given(st.sampled_from(MEANS), rates, numbers, numbers, st.integers(5, 30))
def test_an_oscillators_averages_are_those_of_cosines(
    mean: tuple[str, Callable[[Fraction, Fraction], Fraction]], b: int, p: Fraction, q: Fraction,
    digits: int,
) -> None:  # fmt: skip
    """H = p²/2 + b q²/2 = e: ⟨p²⟩ = e, ⟨q²⟩ = e/b."""
    assume(p or q)
    text, true = mean
    energy = p**2 / 2 + b * q**2 / 2
    found = average(oscillator(1, b, Fraction(0)), element(text), (p, q), digits)
    greatest = Fraction(10) * (1 + energy) ** 2
    assert abs(found.value - true(energy, Fraction(b))) <= found.bound + Fraction(greatest, 10 ** (digits + 5))  # fmt: skip
    assert 0 < found.bound <= Fraction(greatest, 10**digits)
    assert found.period is not None
    period, within = found.period
    with mpmath.workdps(60):
        exact = 2 * mpmath.pi / mpmath.sqrt(b)
        assert abs(mpf(period) - exact) <= mpf(within) * 2 + exact * mpmath.mpf(10) ** -(digits + 5)
        assert mpf(within) <= exact * mpmath.mpf(10) ** -digits
    assert len(found.values) == len(found.orbit.points)
    inside = found.orbit.values(element(text))
    assert [float(x) for x in inside] == list(found.values)


@few
@given(rates, numbers, numbers, st.integers(0, 60), st.sampled_from(["q**2", "p*q", "q", "q**3 + p"]))
def test_the_bounded_part_is_the_integral_of_what_is_not_the_mean(
    b: int, p: Fraction, q: Fraction, part: int, text: str
) -> None:
    assume(p or q)
    found = average(oscillator(1, b, Fraction(0)), element(text), (p, q), 10)
    at = bounded_part(found)
    assert found.period is not None
    time = float(found.period[0]) * part / 61
    z = turned(1, b, mpf(p), mpf(q), time)
    size = float(abs(p) + abs(q) + 1) ** 3

    def g(t: Any) -> Any:
        y, x = turned(1, b, mpf(p), mpf(q), t)
        return {"q**2": x * x, "p*q": x * y, "q": x, "q**3 + p": x**3 + y}[text]

    true = mpmath.quad(g, mpmath.linspace(0, time, 5)) - time * mpf(found.value)
    state = tuple(found.orbit.flow.number(Fraction(str(mpmath.nstr(x, 20)))) for x in z)
    assert abs(at((state[0], state[1])) - float(true)) < 1e-9 * size
    apart = (phase(found.orbit, (state[0], state[1])) - time) / float(found.period[0])
    assert abs(apart - round(apart)) < 1e-9


@settings(deadline=None, max_examples=5)
@given(st.integers(1, 3), st.integers(3, 9), st.integers(-2, 3), st.integers(1, 9))
def test_a_rotations_phase_is_the_same_a_turn_further(
    rate: int, p: int, turns: int, tenth: int
) -> None:
    hamiltonian = Hamiltonian.parse(f"p**2/2 - cos({rate}*q)")
    found = average(hamiltonian, element("p"), (Fraction(p), Fraction(0)), 10)
    orbit: Orbit = found.orbit
    assert orbit.kind == "rotation"
    assert found.period is not None
    true = 2 * math.pi / rate / float(found.period[0])
    assert abs(float(found.value) - true) < 1e-9, "the mean of p is a turn over the period"
    z = orbit.points[tenth]
    time = float(orbit.time(Fraction(tenth, len(orbit.points))))
    moved = z[0] + turns * orbit.shift[0], z[1] + turns * orbit.shift[1]
    assert abs(phase(orbit, moved) - time) < 1e-9
    assert abs(bounded_part(found)(moved) - bounded_part(found)(z)) < 1e-9


@pytest.mark.parametrize("text", ["1/(q - 1/2)", "log(q)", "sqrt(q)"])
def test_what_is_not_defined_along_the_orbit_has_no_average(text: str) -> None:
    with pytest.raises(NoFlowError):
        found: Average = average(oscillator(1, 1, Fraction(0)), element(text), (Fraction(0), Fraction(1)), 8)
        assert found is None
