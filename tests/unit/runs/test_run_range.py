"""Runs at their edges: orbits that leave the range, thinned series, what is asked for.

The oracles are plain Python loops over the paper's formulas.
"""

import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import pytest
from mpmath.ctx_mp import MPContext

from verify import arithmetic
from verify.arithmetic.number_system import ESCAPE_BITS
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.observables import CLOSED_FORM, REPORTED
from verify.scenes.results.run import RunResult

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4")
HENON = Hamiltonian.parse("p**2/2 + q**2/2 - q**3/3")


def duffing_steps(q: Any, p: Any, h: Any) -> Iterator[tuple[Any, Any, Any]]:
    """(p, q) after each step of lie2 with δ = 1 (Eq. 19), and the step's ΔJ."""
    while True:
        dj = 3 * h * h * h * p * q + h * h * h * h * (1 + 3 * q * q) * (1 + 3 * q * q) / 4
        p, q = (
            p - h * (q + q * q * q) - h * h / 2 * p * (1 + 3 * q * q),
            q + h * p - h * h / 2 * (q + q * q * q),
        )
        yield p, q, dj


# -- leaving the range ----------------------------------------------------------------------------

ESCAPES = [(3, 0, 1), (2, 1, 1), (Fraction(5, 2), -1, Fraction(3, 4)), (40, 0, Fraction(1, 8))]
escapes = pytest.mark.parametrize(("q", "p", "h"), ESCAPES, ids=lambda x: str(x))


def first_step_outside(q: Any, p: Any, h: Any, inside: Callable[[Any], bool]) -> int:
    steps = duffing_steps(q, p, h)
    return next(k for k, (p, q, _) in enumerate(steps, 1) if not (inside(p) and inside(q)))


def duffing_run(name: str, steps: int, *, q: Any, p: Any, h: Any, **options: Any) -> RunResult:
    return run(DUFFING.with_values({"delta": 1}), "lie2", q=q, p=p, step_size=h, steps=steps,
               arithmetic=name, **options)  # fmt: skip


@escapes
def test_float64_says_at_which_step_the_orbit_is_no_longer_finite(q: Any, p: Any, h: Any) -> None:
    true = first_step_outside(float(q), float(p), float(h), math.isfinite)
    assert 3 < true < 100
    for steps in (true, true + 1, 1000, 10**7):
        found = duffing_run("float64", steps, q=q, p=p, h=h, observables=())
        assert (found.status, found.failed_step, found.values) == ("left range", true, {})
    assert duffing_run("float64", true - 1, q=q, p=p, h=h, observables=()).status == "finished"


@escapes
def test_float64_says_at_which_step_a_sum_is_no_longer_finite(q: Any, p: Any, h: Any) -> None:
    squares, steps = 0.0, duffing_steps(float(q), float(p), float(h))
    for true, (p_next, q_next, dj) in enumerate(steps, 1):  # noqa: B007 - used after the loop
        squares += dj * dj
        if not all(map(math.isfinite, (p_next, q_next, squares))):
            break
    found = duffing_run("float64", 1000, q=q, p=p, h=h, observables=("mse",))
    assert (found.status, found.failed_step) == ("left range", true)


@escapes
def test_mpmath_stops_an_orbit_at_the_step_that_escapes(q: Any, p: Any, h: Any) -> None:
    context = MPContext()
    context.prec = 150
    most = context.ldexp(1, ESCAPE_BITS)
    start = (context.mpf(Fraction(x).numerator) / Fraction(x).denominator for x in (q, p, h))
    true = first_step_outside(*start, lambda x: abs(x) < most)
    assert 3 < true < 100
    for steps in (true, true + 1, 5000):
        found = duffing_run("mpmath", steps, q=q, p=p, h=h)
        assert (found.status, found.failed_step, found.values) == ("left range", true, {})
    assert duffing_run("mpmath", true - 1, q=q, p=p, h=h).status == "finished"


Force = Callable[[float], float]
IN_PLANE = {"q": 1, "p": -1, "step_size": "0.1", "steps": 60}
KEPLER = "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)"
HEAD_ON = {"q": [1, 0], "p": [-2, 0], "step_size": "1/2", "steps": 50, "digits": 20}
LEAVING: dict[str, tuple[str, dict[str, Any], Force]] = {
    "square-root": ("p**2/2 + q*sqrt(q)", IN_PLANE, lambda q: 1.5 * math.sqrt(q)),
    "logarithm": ("p**2/2 + q*log(q)", IN_PLANE, lambda q: math.log(q) + 1),
    "cube-root": (
        "p**2/2 + q**(4/3)", IN_PLANE, lambda q: 4 / 3 * (q ** (1 / 3) if q >= 0 else math.nan),
    ),
    "pole": ("p**2/2 + 1/q**2 + q", IN_PLANE, lambda q: 1 - 2 / q**3),
    "collision": (KEPLER, HEAD_ON, lambda q: 1 / q**2),
}  # fmt: skip


@pytest.mark.sample(9)
@pytest.mark.parametrize("name", arithmetic.names())
@pytest.mark.parametrize(("text", "keys", "force"), LEAVING.values(), ids=LEAVING)
def test_an_orbit_that_leaves_the_domain_of_h_is_stopped_or_stays_real(
    name: str, text: str, keys: dict[str, Any], force: Force
) -> None:
    """In the plane, or on a straight line to a centre of force."""
    result = run(Hamiltonian.parse(text), "lie1", **keys, arithmetic=name)
    h = float(Fraction(keys["step_size"]))
    q, p = (float(x[0] if isinstance(x, list) else x) for x in (keys["q"], keys["p"]))
    outside = None
    for k in range(1, keys["steps"] + 1):
        try:
            p, q = p - h * force(q), q + h * p
        except (ValueError, ZeroDivisionError):
            p = math.nan
        if not math.isfinite(p):
            outside = k
            break
    assert result.failed_step == outside
    assert result.status == ("left range" if outside else "finished")


CHAOTIC = {"q": "0.01", "p": "-0.5", "step_size": 1, "steps": 1000}


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", arithmetic.names())
def test_a_product_of_astronomical_size_is_not_written_out(name: str) -> None:
    """Λ = (1 + h²)^N − 1 is known in closed form, and has billions of digits."""
    turning = Hamiltonian.parse("p**2/2 + q**2/2")
    for q in (1, 0):
        found = run(turning, "lie1", q=q, p=0, step_size=10**60, steps=10**9, arithmetic=name)
        assert found.status == "left range"
        assert not found.values


@pytest.mark.parametrize(("name", "digits"), [("float64", 17), ("mpmath", 2)])
def test_an_orbit_whose_escape_depends_on_rounding_is_given_no_digit(
    name: str, digits: int
) -> None:
    exact = run(HENON, "symplectic-euler", **CHAOTIC, arithmetic="mpmath", digits=400)
    assert exact.status == "left range"
    assert exact.failed_step is not None
    assert exact.failed_step < 800
    found = run(HENON, "symplectic-euler", **CHAOTIC, arithmetic=name, digits=digits)
    # Beyond that step |q| is squared at every step: no bound near a bounded value holds.
    assert found.status in ("left range", "unresolved")
    assert not found.values


@pytest.mark.parametrize("steps", [200, 20_001], ids=["by-mpfr", "compensated"])
@pytest.mark.parametrize("h", ["1e-60", "1e-400"])
def test_an_underflow_is_not_given_as_an_exact_zero(steps: int, h: str) -> None:
    """ΔJ is about 1.5 h³, so that ΔJ², or ΔJ itself, is too small for float64, and is not 0."""
    found = duffing_run("float64", steps, q=1, p=Fraction(1, 2), h=Fraction(h))
    for name in CLOSED_FORM:
        value = found.values[name]
        assert (value.value, value.bound) != ("0", "0"), name
        assert found.exact == ()


# -- series ---------------------------------------------------------------------------------------


@pytest.mark.sample(8)
@pytest.mark.parametrize("name", arithmetic.names())
@pytest.mark.parametrize(
    ("steps", "points"),
    [(1, 2), (2, 2), (7, 3), (100, 7), (101, 600), (600, 600), (9001, 2), (9001, 600)],
)
def test_a_series_covers_every_step_once_in_at_most_so_many_points(
    name: str, steps: int, points: int
) -> None:
    found = duffing_run(name, steps, q=1, p=0, h=Fraction(1, 100), points=points)
    covered = [k for point in found.series for k in range(point.first, point.last + 1)]
    assert covered == list(range(1, steps + 1))
    assert len(found.series) <= points


def test_a_long_series_in_float64_has_at_most_so_many_points() -> None:
    found = duffing_run("float64", 9_000_000, q=1, p=0, h=Fraction(1, 1000), points=2)
    assert len(found.series) <= 2


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", arithmetic.names())
@pytest.mark.parametrize(("steps", "points"), [(50, 50), (1000, 13), (1000, 999)])
def test_the_extremes_of_a_series_are_those_of_a_plain_loop(
    name: str, steps: int, points: int
) -> None:
    found = duffing_run(name, steps, q=Fraction(3, 2), p=0, h=Fraction(1, 20), points=points)
    lam, loop, all_dj = 0.0, duffing_steps(1.5, 0.0, 0.05), []
    for point in found.series:
        lams, djs = [], []
        for _ in range(point.first, point.last + 1):
            dj = next(loop)[2]
            lam = lam + dj + lam * dj
            lams.append(lam)
            djs.append(dj)
        all_dj += djs
        for (low, high), true in ((point.delta_j, djs), (point.lam, lams)):
            assert float(low) == pytest.approx(min(true), rel=1e-6, abs=1e-14)
            assert float(high) == pytest.approx(max(true), rel=1e-6, abs=1e-14)
    assert min(all_dj) < 0 < max(all_dj), "else least and greatest could be mixed up unseen"
    assert float(found.values["lambda"].value) == pytest.approx(lam, rel=1e-9)


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("name", arithmetic.names())
def test_points_do_not_change_the_values(name: str) -> None:
    plain = duffing_run(name, 320, q=1, p=0, h=Fraction(1, 100), observables=REPORTED)
    thinned = duffing_run(name, 320, q=1, p=0, h=Fraction(1, 100), observables=REPORTED, points=40)
    assert plain.values == thinned.values
    assert (plain.series, len(thinned.series)) == ((), 40)


# -- what is asked for ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["float64", "mpmath"])
def test_a_map_that_is_not_defined_at_the_step_size_leaves_the_range_at_once(name: str) -> None:
    """What does not depend on the state is computed before the loop, and may fail there."""
    scheme = "p_next = p - h*q/(1 - 10*h); q_next = q + h*p"
    at: dict[str, Any] = {"q": 1, "p": 0, "steps": 3, "arithmetic": name}
    found = run(Hamiltonian.parse("p**2/2 + q**2/2"), scheme, step_size="0.1", **at)
    assert (found.status, found.failed_step, found.values) == ("left range", 1, {})
    defined = run(Hamiltonian.parse("p**2/2 + q**2/2"), scheme, step_size="0.2", **at)
    assert defined.status == "finished"


def test_the_observables_asked_for_are_those_that_come_back() -> None:
    for asked in ((), ("mse",), ("lambda", "mse"), CLOSED_FORM, REPORTED):
        found = duffing_run("float64", 10, q=1, p=0, h=Fraction(1, 10), observables=asked)
        assert set(found.values) == {"p", "q", *asked}
