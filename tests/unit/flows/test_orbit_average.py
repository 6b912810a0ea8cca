"""Closed orbits of the exact flow and averages along them, against elliptic integrals."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest

from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.flows.closed_orbit import ClosedOrbit, closed_orbit
from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.flows.orbit_average import Average, average, bounded_part, phase
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

PENDULUM = "p**2/2 - cos(q)"
DUFFING = "p**2/2 + q**2/2 + q**4/4"
Exact = str | int


def averaged(formula: str, g: str, p: Exact, q: Exact, digits: int = 15) -> Average:
    hamiltonian = Hamiltonian.parse(formula)
    ring, (x,) = embed([parse(g)], ("p", "q"))
    return average(hamiltonian, (ring, x), (Fraction(p), Fraction(q)), digits)


def orbit(formula: str, p: Exact, q: Exact, digits: int = 15) -> ClosedOrbit:
    return closed_orbit(Hamiltonian.parse(formula), (Fraction(p), Fraction(q)), digits, 32)


def agrees(found: tuple[Fraction, Fraction], true: Any, digits: int) -> None:
    """The value is within its bound of the truth, and the bound as small as was asked for."""
    value, bound = found
    assert abs(mpmath.mpf(value.numerator) / value.denominator - true) <= bound * mpmath.mpf(1.01)
    assert bound <= Fraction(1, 10**digits) * max(1, abs(Fraction(value)))


# -- closed forms ---------------------------------------------------------------------------------


def swing(q: Any) -> tuple[Any, Any]:
    """The pendulum from rest at q: its period, and the average of cos² q."""
    m = mpmath.sin(q / 2) ** 2
    k, e = mpmath.ellipk(m), mpmath.ellipe(m)
    square = (k - e) / (m * k)  # of sn, over a period
    fourth = ((2 + m) * k - 2 * (1 + m) * e) / (3 * m**2 * k)
    return 4 * k, 1 - 4 * m * square + 4 * m**2 * fourth


def turning(p: Any) -> tuple[Any, Any]:
    """The pendulum that goes round from q = 0 with momentum p > 2: period and average of cos² q."""
    m = 4 / p**2
    k, e = mpmath.ellipk(m), mpmath.ellipe(m)
    square = (k - e) / (m * k)
    fourth = ((2 + m) * k - 2 * (1 + m) * e) / (3 * m**2 * k)
    return 4 * k / p, 1 - 4 * square + 4 * fourth


def hard_spring(a: Any) -> tuple[Any, Any]:
    """Duffing, δ = 1, from rest at a: its period, and the average of q² (q = a cn)."""
    m = a**2 / (2 * (1 + a**2))
    k, e = mpmath.ellipk(m), mpmath.ellipe(m)
    return 4 * k / mpmath.sqrt(1 + a**2), a**2 * (e - (1 - m) * k) / (m * k)


CLOSED_FORMS: dict[str, tuple[str, str, Exact, Exact, Any]] = {
    "swing": (PENDULUM, "cos(q)**2", 0, "3/2", lambda: swing(mpmath.mpf(3) / 2)),
    "wide-swing": (PENDULUM, "cos(q)**2", 0, "31/10", lambda: swing(mpmath.mpf(31) / 10)),
    "round": (PENDULUM, "cos(q)**2", "5/2", 0, lambda: turning(mpmath.mpf(5) / 2)),
    "round-backwards": (PENDULUM, "cos(q)**2", "-5/2", 0, lambda: turning(mpmath.mpf(5) / 2)),
    "duffing": (DUFFING, "q**2", 0, "3/2", lambda: hard_spring(mpmath.mpf(3) / 2)),
    "duffing-small": (DUFFING, "q**2", 0, "1/10", lambda: hard_spring(mpmath.mpf(1) / 10)),
    # H = f(r²) goes round circles with the angular velocity r² (neither T + V, nor harmonic).
    "circle": (
        "(p**2 + q**2)**2/4", "q**4", "6/5", "-8/5",
        lambda: (mpmath.pi / 2, mpmath.mpf(6)),
    ),
    "tilted": ("p**2 + p*q + q**2/2", "p**2", 1, 0, lambda: (2 * mpmath.pi, mpmath.mpf(1))),
}  # fmt: skip


EXACT_TO = [(name, digits) for name in CLOSED_FORMS for digits in (5, 20)]
EXACT_TO += [("swing", 40), ("circle", 40)]


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize(("name", "digits"), EXACT_TO)
def test_period_and_average_are_those_in_closed_form(name: str, digits: int) -> None:
    formula, g, p, q, closed_form = CLOSED_FORMS[name]
    found = averaged(formula, g, p, q, digits)
    with mpmath.workdps(80):
        period, mean = closed_form()
        assert found.period is not None
        agrees(found.period, period, digits)
        agrees((found.value, found.bound), mean, digits)


def test_a_wrong_closed_form_would_be_seen() -> None:
    found = averaged(PENDULUM, "cos(q)**2", 0, "3/2", 30)
    with mpmath.workdps(80):
        _, mean = swing(mpmath.mpf(3) / 2 + mpmath.mpf(10) ** -28)
        with pytest.raises(AssertionError):
            agrees((found.value, found.bound), mean, 30)


def test_what_averages_to_zero_is_zero_within_its_bound() -> None:
    found = averaged(PENDULUM, "p*sin(q)", "3/10", "3/2", 20)
    assert abs(found.value) <= found.bound < Fraction(1, 10**19)


def test_harmonics_that_alias_are_not_averaged() -> None:
    """cos 32t is 1 at 8, 16 or 32 equally spaced times: their means agree, and are wrong."""
    found = averaged("p**2/2 + q**2/2", chebyshev(32), 0, 1, 12)
    assert abs(found.value) < Fraction(1, 10**11)


def chebyshev(n: int) -> str:
    """The text of cos(n arccos q) as a polynomial in q."""
    before, last = [1], [0, 1]
    for _ in range(n - 1):
        doubled = [0, *(2 * c for c in last)]
        padded = before + [0] * (len(doubled) - len(before))
        before, last = last, [a - b for a, b in zip(doubled, padded, strict=True)]
    return " + ".join(f"({c})*q**{k}" for k, c in enumerate(last) if c)


# -- what is closed, and what is not --------------------------------------------------------------

KINDS: dict[str, tuple[str, Exact, Exact, str]] = {
    "swing": (PENDULUM, 0, 1, "libration"),
    "round": (PENDULUM, "21/10", 0, "rotation"),
    "long-period-of-H": ("p**2/2 - cos(q/2) + sin(3*q/2)/5", 3, 1, "rotation"),
    "round-in-p": ("q**2/2 - cos(p)", 1, 3, "rotation"),
    "lattice": ("cos(p) + 2*cos(q)", "1/2", "1/2", "libration"),
    "no-T-plus-V": ("p*q*(1 - p - q)", "1/4", "1/4", "libration"),
    "at-rest": (PENDULUM, 0, 0, "equilibrium"),
    "at-rest-elsewhere": ("p*q*(1 - p - q)", "1/3", "1/3", "equilibrium"),
    "with-a-pole": ("p**2/2 + q + 1/q", "1/10", 1, "libration"),
    "in-one-of-two-wells": ("p**2/2 + q**4/4 - q**2/2", 0, "1/10", "libration"),
    "around-both-wells": ("p**2/2 + q**4/4 - q**2/2", "1/10", "-1/3", "libration"),
    "stiff": ("p**2/2 + 10**12*q**2/2", 1, 0, "libration"),
    "tiny": (DUFFING, 0, "1e-12", "libration"),
    "near-the-separatrix": (PENDULUM, "2.0000001", 0, "rotation"),
}


@pytest.mark.parametrize("case", KINDS.values(), ids=KINDS)
def test_a_closed_orbit_is_found_and_closes(case: tuple[str, Exact, Exact, str]) -> None:
    formula, p, q, kind = case
    found = orbit(formula, p, q)
    assert found.kind == kind
    if found.period is None:
        return
    flow, reach = found.flow, max(abs(z[0] - found.points[0][0]) + abs(z[1] - found.points[0][1])
                                  for z in found.points)  # fmt: skip
    end = flow.advance(found.points[-1], found.time(Fraction(1, len(found.points))))
    first = [float(x) for x in found.points[0]]
    for x, x0, shift in zip(end, found.points[0], found.shift, strict=True):
        assert abs(float(x - x0 - shift)) < 1e-12 * float(reach)
    # It is the first time round: nothing between comes near z₀.
    near = [z for z in found.points[1:] if abs(float(z[0]) - first[0]) + abs(float(z[1]) - first[1])
            < 1e-3 * float(reach)]  # fmt: skip
    assert not near


def test_the_period_around_both_wells_is_the_integral_over_q() -> None:
    """Non-convex: the orbit crosses the normal line through its start four times."""
    found = orbit("p**2/2 + q**4/4 - q**2/2", "1/10", "-1/3")
    with mpmath.workdps(30):
        energy = mpmath.mpf(1) / 200 + mpmath.mpf(1) / 324 - mpmath.mpf(1) / 18
        assert energy < 0  # it goes around the left well only
        inner = mpmath.sqrt(1 - mpmath.sqrt(1 + 4 * energy))
        outer = mpmath.sqrt(1 + mpmath.sqrt(1 + 4 * energy))
        time = mpmath.quad(
            lambda q: 2 / mpmath.sqrt(2 * (energy + q**2 / 2 - q**4 / 4)), [inner, 1, outer]
        )
        assert abs(mpmath.mpf(str(found.period)) / time - 1) < 1e-10


REFUSED: dict[str, tuple[str, Exact, Exact, str]] = {
    "separatrix": (PENDULUM, 2, 0, "separatrix"),
    "separatrix-of-two-wells": ("p**2/2 + q**4/4 - q**2/2", 0, "0", ""),
    "free": ("p**2/2", 1, 1, "far away"),
    "falling": ("p**2/2 + q", 1, 1, "far away"),
    "blow-up": ("p**2/2 - q**4", 1, 1, "far away"),
    "cusp": ("p**2/2 + q**3", 1, 1, "far away"),
    "into-a-saddle": ("p*q*(1 - p - q)", "1/2", "1/2", "comes to rest"),
    "not-defined-there": ("p**2/2 + log(q)", 0, -1, "not defined at the initial value"),
    "beyond-a-root": ("p**2/2 + sqrt(q)", 0, 1, "comes to rest, leaves"),
    "period-that-is-no-multiple-of-pi": ("p**2/2 - cos(sqrt(2)*q)", 3, 0, "not seen to close"),
}


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("case", REFUSED.values(), ids=REFUSED)
def test_what_is_not_known_to_be_closed_has_no_average(
    case: tuple[str, Exact, Exact, str],
) -> None:
    formula, p, q, reason = case
    if not reason:  # the twin: the saddle itself is an equilibrium
        assert orbit(formula, p, q).kind == "equilibrium"
        return
    with pytest.raises(NoFlowError, match=reason):
        averaged(formula, "q", p, q)


@pytest.mark.left_to_ci
def test_near_the_separatrix_the_digits_asked_for_are_there_all_the_same() -> None:
    found = averaged(PENDULUM, "cos(q)**2", "2.000000000001", 0, 14)
    with mpmath.workdps(60):
        period, mean = turning(mpmath.mpf("2.000000000001"))
        assert found.period is not None
        agrees(found.period, period, 12)
        agrees((found.value, found.bound), mean, 14)


# -- the bounded part -----------------------------------------------------------------------------


def test_the_bounded_part_is_the_integral_of_what_is_not_the_average() -> None:
    """On q = 2 cos t, p = −2 sin t: q² − 2 = 2 cos 2t, whose integral is sin 2t."""
    part = bounded_part(averaged("p**2/2 + q**2/2", "q**2", 0, 2))
    number = NumericalFlow(canonical_field(Hamiltonian.parse("p**2/2 + q**2/2"))[0], 15).number
    for k in range(-20, 20):
        t = mpmath.mpf(k) / 3
        z = tuple(number(Fraction(float(x))) for x in (-2 * mpmath.sin(t), 2 * mpmath.cos(t)))
        assert abs(part((z[0], z[1])) - mpmath.sin(2 * t)) < 1e-12


@pytest.mark.parametrize("turns", [-3, 0, 7])
def test_on_a_rotation_whole_turns_make_no_difference(turns: int) -> None:
    found = averaged(PENDULUM, "cos(q)**2 + p", "5/2", 0)
    part = bounded_part(found)
    p, q = found.orbit.points[5]
    q_moved = q + turns * found.orbit.shift[1]
    assert abs(part((p, q_moved)) - part((p, q))) < 1e-9


def test_a_point_beside_the_orbit_takes_the_phase_of_the_nearest_one() -> None:
    found = averaged("p**2/2 + q**2/2", "q**2", 0, 2)
    number = found.orbit.flow.number
    z = number(Fraction(-3, 1000)), number(Fraction(23, 10))  # outside, at t = atan(0.003 / 2.3)
    assert phase(found.orbit, z) == pytest.approx(float(mpmath.atan(0.003 / 2.3)), abs=1e-9)


def test_a_point_far_from_the_orbit_has_some_phase_and_no_error() -> None:
    found = averaged(PENDULUM, "cos(q)**2", 0, "3/2")
    number = found.orbit.flow.number
    for far in (0, 10, -300):
        assert abs(phase(found.orbit, (number(Fraction(far)), number(Fraction(7))))) < 100
