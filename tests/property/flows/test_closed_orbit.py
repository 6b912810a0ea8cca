"""The exact flow for any time, and averages along orbits that are cosines."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.oscillators import digits_of, element, mpf, numbers, oscillator, rates, turned
from tests.helpers.sampled.formulas import polynomials
from verify.flows.closed_orbit import ClosedOrbit
from verify.flows.compiled_functions import functions_at
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.orbit_average import average, bounded_part, phase
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

few = drawn(8)


# -- the flow -------------------------------------------------------------------------------------


@few
@given(rates, rates, numbers, numbers, st.integers(-40, 40), digits_of)
def test_the_flow_is_followed_for_any_time_forth_and_back(
    a: int, b: int, p: Fraction, q: Fraction, tenths: int, digits: int
) -> None:
    field, _ = canonical_field(oscillator(a, b, Fraction(0)))
    flow, time = NumericalFlow(field, digits), Fraction(tenths, 10)
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
    [
        ("p**2/2 - q**4/4", "1", "1", "5", "at about t = "),
        ("p**2/2 + sqrt(q)", "0", "-1", "1", "leaves where H"),
        ("p**2/2 + log(q)", "0", "1", "5", "at about t = "),
        ("p**2/2 - q**4/4", "1", "1", "-9", "at about t = "),
        ("p**2/2 - q**4/4", "-1", "1", "-9", "at about t = -"),
    ],
)
def test_a_flow_that_ends_says_about_when(text: str, p: str, q: str, time: str, said: str) -> None:
    field, _ = canonical_field(Hamiltonian.parse(text))
    flow = NumericalFlow(field, 12)
    with pytest.raises(NoFlowError, match=said):
        flow.follow((flow.number(Fraction(p)), flow.number(Fraction(q))), Fraction(time))


@pytest.mark.parametrize(
    ("text", "p", "q", "time"),
    [
        ("p**2/2 - q**4/4", "1", "1", "9"),
        ("p**2/2 + log(q)", "0", "1", "7"),
        ("p**2/2 - q**4/4", "-1", "1", "-9"),
    ],
)
def test_a_flow_is_not_advanced_beyond_its_end(text: str, p: str, q: str, time: str) -> None:
    flow = NumericalFlow(canonical_field(Hamiltonian.parse(text))[0], 8)
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
    flow = NumericalFlow(canonical_field(oscillator(1, b, Fraction(0)))[0], digits)
    z = flow.number(p), flow.number(q)
    longest = next(
        Fraction(n, 64) for n in range(1, 640) if flow.step(z, flow.number(Fraction(n, 64))) is None
    )
    tried: list[bool] = []
    one = flow.step

    def counted(*given: Any) -> Any:
        tried.append(one(*given) is not None)
        return one(*given)

    flow.step = counted  # type: ignore[method-assign]
    flow.follow(z, sign * 40 * longest)
    assert tried.count(True) + 2 >= 40
    assert tried.count(True) <= 75
    assert tried.count(False) <= tried.count(True) / 3 + 3


@few
@given(rates, st.integers(-900, 900), numbers, numbers, st.integers(-40, 40), digits_of)
def test_a_quarter_turn_of_the_plane_turns_every_bit_of_a_step(
    rate: int, c: int, p: Fraction, q: Fraction, part: int, digits: int
) -> None:
    """(p, q) → (−q, p) is canonical: a circle about (c, c) becomes one about (−c, c)."""
    ends = []
    for middle, z in ((c, (c + p, c + q)), (-c, (-c - q, c + p))):
        text = f"{rate}*((p - ({middle}))**2 + (q - ({c}))**2)/2"
        flow = NumericalFlow(canonical_field(Hamiltonian.parse(text))[0], digits)
        time = flow.number(Fraction(part, 10 * rate))
        end = flow.step((flow.number(z[0]), flow.number(z[1])), time)
        ends.append(end and [flow.arithmetic.exact(x) for x in end])
    one, turned_ = ends
    assert turned_ == (one and [-one[1], one[0]])


@few
@given(polynomials("pq", 3, 3), numbers, numbers)
def test_functions_at_a_point_are_what_they_are(text: str, p: Fraction, q: Fraction) -> None:
    field, _ = canonical_field(oscillator(1, 1, Fraction(0)))
    flow = NumericalFlow(field, 30)
    at = functions_at(flow.arithmetic, [element(text), element(f"cos(q)*({text})")])
    with flow.arithmetic.context():
        one, other = at(flow.number(p), flow.number(q))
    names = {n: sympy.Rational(str(x)) for n, x in (("p", p), ("q", q))}
    true = sympy.sympify(text, locals={n: sympy.Symbol(n) for n in "pq"}, rational=True).subs(names)
    with mpmath.workdps(40):
        value = mpmath.mpf(sympy.N(true, 40))
        assert abs(mpf(one) - value) <= abs(value) * mpmath.mpf(10) ** -28 + mpmath.mpf(10) ** -28
        assert (
            abs(mpf(other) - value * mpmath.cos(mpf(q))) <= (1 + abs(value)) * mpmath.mpf(10) ** -28
        )


# -- averages -------------------------------------------------------------------------------------

MEANS: list[tuple[str, Callable[[Fraction, Fraction], Fraction]]] = [
    ("q**2", lambda e, f: e / f),
    ("p**2", lambda e, f: e),
    ("q", lambda e, f: Fraction(0)),
    ("p*q + 5", lambda e, f: Fraction(5)),
    ("q**4", lambda e, f: Fraction(3, 2) * e * e / f / f),
    ("3*p**2*q**2 + q**3", lambda e, f: Fraction(3, 2) * e * e / f),
]


@few
@given(st.sampled_from(MEANS), rates, numbers, numbers, st.integers(5, 30))
def test_an_oscillators_averages_are_those_of_cosines(
    mean: tuple[str, Callable[[Fraction, Fraction], Fraction]],
    b: int,
    p: Fraction,
    q: Fraction,
    digits: int,
) -> None:
    """H = p²/2 + b q²/2 = e: ⟨p²⟩ = e, ⟨q²⟩ = e/b."""
    assume(p or q)
    text, true = mean
    energy = p**2 / 2 + b * q**2 / 2
    found = average(oscillator(1, b, Fraction(0)), element(text), (p, q), digits)
    greatest = Fraction(10) * (1 + energy) ** 2
    assert abs(found.value - true(energy, Fraction(b))) <= found.bound + Fraction(
        greatest, 10 ** (digits + 5)
    )
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
@given(rates, numbers, numbers, st.integers(-9, 9).filter(bool), st.integers(5, 30))
def test_a_constants_average_is_itself_and_may_be_off_by_a_unit_of_ten_digits_more(
    b: int, p: Fraction, q: Fraction, constant: int, digits: int
) -> None:
    assume(p or q)
    found = average(oscillator(1, b, Fraction(0)), element(str(constant)), (p, q), digits)
    assert found.value == constant
    assert found.bound == Fraction(abs(constant), 10 ** (digits + 10))


@few
@given(
    rates, numbers, numbers, st.integers(0, 60), st.sampled_from(["q**2", "p*q", "q", "q**3 + p"])
)
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


@drawn(5)
@given(st.integers(1, 3), st.integers(3, 9), st.integers(-2, 3), st.integers(1, 9))
def test_a_rotations_phase_is_the_same_a_turn_further(
    rate: int, p: int, turns: int, tenth: int
) -> None:
    hamiltonian = Hamiltonian.parse(f"p**2/2 - cos({rate}*q)")
    found = average(hamiltonian, element("p"), (Fraction(p), Fraction(0)), 10)
    orbit: ClosedOrbit = found.orbit
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
    start = Fraction(0), Fraction(1)
    with pytest.raises(NoFlowError):
        average(oscillator(1, 1, Fraction(0)), element(text), start, 8)
