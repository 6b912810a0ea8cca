"""Drawn H(p, q, t): properties that only time has, each with what would break it.

Steps are made by hand, too, in mpmath, from sympy's derivatives of H; t is a coordinate with t' = 1
there, and no code of the toolkit takes part.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy
from hypothesis import HealthCheck, Phase, find, given, reject, settings
from hypothesis import strategies as st

from tests.examples import drawn
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.map_symmetry import judge_symmetry
from verify.proof.order_for_one_h import prove
from verify.runs.requested_run import run
from verify.schemes import get
from verify.strategies.hamiltonians import hamiltonians
from verify.verdict import Verdict

p, q, t, h = map(symbol, "pqth")
DIGITS = 25
SIZE = Fraction(1, 64)
START = {"p": Fraction(1, 3), "q": Fraction(-2, 5)}
few = settings(drawn(12), derandomize=True, database=None,
               suppress_health_check=list(HealthCheck))  # fmt: skip
moments = st.fractions(-3, 3, max_denominator=7)
in_time = hamiltonians(time_dependent=True, degree=4, terms=3)
separable = hamiltonians(time_dependent=True, degree=4, terms=3, separable=True)
Point = tuple[Any, Any]


def number(x: Fraction) -> Any:
    return mpmath.mpf(x.numerator) / x.denominator


def gradient(exact: sympy.Expr) -> Callable[..., Point]:
    made: Callable[..., Point] = sympy.lambdify(
        (p, q, t), (exact.diff(p), exact.diff(q)), modules="mpmath"
    )
    return made


def lie2(exact: sympy.Expr, y: Any, z: Any, time: Any, size: Any) -> Point:
    """z + h Dz + h²/2 D²z with D = ∂_t + X."""

    def derived(x: sympy.Expr) -> sympy.Expr:
        return x.diff(t) + exact.diff(p) * x.diff(q) - exact.diff(q) * x.diff(p)

    series = [x + h * derived(x) + h**2 / 2 * derived(derived(x)) for x in (p, q)]
    made = sympy.lambdify((p, q, t, h), series, modules="mpmath")
    first, second = made(y, z, time, size)
    return first, second


def rk4(exact: sympy.Expr, y: Any, z: Any, time: Any, size: Any) -> Point:
    slopes = gradient(exact)

    def f(y: Any, z: Any, time: Any) -> Point:
        by_p, by_q = slopes(y, z, time)
        return -by_q, by_p

    half = size / 2
    k1 = f(y, z, time)
    k2 = f(y + half * k1[0], z + half * k1[1], time + half)
    k3 = f(y + half * k2[0], z + half * k2[1], time + half)
    k4 = f(y + size * k3[0], z + size * k3[1], time + size)
    first, second = (
        x + size / 6 * (a + 2 * b + 2 * c + d)
        for x, a, b, c, d in zip((y, z), k1, k2, k3, k4, strict=True)
    )
    return first, second


def verlet(exact: sympy.Expr, y: Any, z: Any, time: Any, size: Any) -> Point:
    """Kicks at t and t + h, the drift at t + h/2."""
    slopes = gradient(exact)
    y = y - size / 2 * slopes(y, z, time)[1]
    z = z + size * slopes(y, z, time + size / 2)[0]
    return y - size / 2 * slopes(y, z, time + size)[1], z


BY_HAND = {"lie2": lie2, "rk4": rk4, "stormer-verlet": verlet}


def one_step(made: Hamiltonian, scheme: str, t0: Fraction, steps: int = 1) -> list[tuple[Any, Any]]:
    """p and q after the steps, each with its bound."""
    found = run(made, scheme, **START, step_size=SIZE, steps=steps, t0=t0, digits=DIGITS,
                arithmetic="mpfr", observables=())  # fmt: skip
    if found.status != "finished":
        reject()
    return [(Fraction(found.values[n].value), Fraction(found.values[n].bound)) for n in ("p", "q")]


@pytest.mark.sample(2)
@pytest.mark.parametrize("scheme", BY_HAND)
@few
@given(made=separable, t0=moments)
def test_a_step_is_that_of_the_extended_autonomous_system(
    scheme: str, made: Hamiltonian, t0: Fraction
) -> None:
    with mpmath.workdps(40):
        start = number(START["p"]), number(START["q"])
        wanted = BY_HAND[scheme](made.exact, *start, number(t0), number(SIZE))
        for (value, bound), true in zip(one_step(made, scheme, t0), wanted, strict=True):
            assert abs(number(value) - true) <= number(bound) + mpmath.mpf(10) ** -35


def test_a_frozen_clock_is_another_step() -> None:
    made = Hamiltonian.parse("p**2/2 + q**2/2 + q*t")
    right, wrong = (
        one_step(made, s, Fraction(1)) for s in ("stormer-verlet", "stormer-verlet, clock frozen")
    )
    assert abs(right[0][0] - wrong[0][0]) > right[0][1] + wrong[0][1]


@pytest.mark.left_to_ci
@pytest.mark.parametrize("scheme", ["lie2", "rk4"])
@few
@given(made=in_time, t0=moments, shift=moments)
def test_h_and_t0_may_be_shifted_together(
    scheme: str, made: Hamiltonian, t0: Fraction, shift: Fraction
) -> None:
    moved = made.exact.subs(t, t + sympy.Rational(shift.numerator, shift.denominator))
    shifted = Hamiltonian.parse(to_text(moved))
    here, there = one_step(made, scheme, t0, 3), one_step(shifted, scheme, t0 - shift, 3)
    for (x, x_bound), (y, y_bound) in zip(here, there, strict=True):
        assert abs(x - y) <= x_bound + y_bound


@pytest.mark.parametrize("scheme", ["lie2", "rk4"])
def test_a_shift_of_h_alone_is_seen(scheme: str) -> None:
    made, moved = (Hamiltonian.parse(f"p**2/2 + q**2/2 + q*({time})") for time in ("t", "t + 1"))
    here, there = (one_step(x, scheme, Fraction(1), 3) for x in (made, moved))
    assert any(abs(x - y) > b + c for (x, b), (y, c) in zip(here, there, strict=True))


@few
@given(made=separable)
def test_a_periodic_h_has_a_periodic_map(made: Hamiltonian) -> None:
    """In t where that stands in cos and sin of k t alone, of period 2π; not in another H."""
    waves = all(f.args[0] == f.args[0].coeff(t) * t for f in made.exact.atoms(sympy.sin, sympy.cos)
                if f.has(t))  # fmt: skip
    outside = made.exact.replace(
        lambda x: isinstance(x, sympy.sin | sympy.cos) and x.has(t), lambda x: sympy.S.One
    )
    periodic = waves and not outside.has(t)
    step = get("lie2").step_map(made).flat
    values = sympy.lambdify((p, q, t, h), list(map(step.ring.expression, step.elements)), "mpmath")
    with mpmath.workdps(40):
        at = number(START["p"]), number(START["q"])
        one, other = (
            values(*at, mpmath.mpf(1) / 3 + k * 2 * mpmath.pi, number(SIZE)) for k in (0, 1)
        )
        apart = max(abs(x - y) for x, y in zip(one, other, strict=True))
        assert (apart < mpmath.mpf(10) ** -30) is periodic


@few
@given(made=in_time)
def test_lie2_is_of_order_3_with_the_divergence_as_its_coefficient(made: Hamiltonian) -> None:
    exact = made.exact

    def derived(x: sympy.Expr) -> sympy.Expr:
        return x.diff(t) + exact.diff(p) * x.diff(q) - exact.diff(q) * x.diff(p)

    fields = [derived(derived(x)) for x in (-exact.diff(q), exact.diff(p))]
    leading = -(fields[0].diff(p) + fields[1].diff(q)) / 6
    proof = prove(get("lie2").step_map(made), get("lie2"))
    assert proof.verdict == "PROVED"
    assert proof.convergence_order is None or proof.convergence_order >= 2
    point = {p: sympy.Rational(1, 3), q: sympy.Rational(2, 7), t: sympy.Rational(3, 5)}
    wanted = leading.subs(point).evalf(40)
    if proof.order == 3:
        found = sympy.sympify(proof.first.text, {"p": p, "q": q, "t": t}).subs(point).evalf(40)
        assert abs(found - wanted) < 1e-30
    else:
        assert abs(wanted) < 1e-30


@few
@given(made=separable)
def test_by_series_the_step_back_begins_at_the_later_time(made: Hamiltonian) -> None:
    """And a clock that stands still is not symmetric, where the force changes."""
    for scheme in ("stormer-verlet", "position-verlet"):
        assert judge_symmetry(get(scheme).step_map(made), 3).verdict is Verdict.UNDECIDED
    still = get("position-verlet, clock frozen").step_map(Hamiltonian.parse("p**2/2 + q*t"))
    assert judge_symmetry(still, 3).verdict is Verdict.REFUTED


@few
@given(made=separable)
def test_splittings_and_the_midpoint_rule_preserve_area(made: Hamiltonian) -> None:
    for name in ("stormer-verlet", "implicit-midpoint", "gauss4", "forest-ruth, clock frozen"):
        try:
            step = get(name).step_map(made)
        except InputError:  # too long
            continue
        assert prove(step, get(name)).area_preserving is True


@few
@given(made=hamiltonians(degree=4, terms=3), t0=moments)
def test_of_an_h_without_t_t0_changes_nothing(made: Hamiltonian, t0: Fraction) -> None:
    assert one_step(made, "lie2", t0) == one_step(made, "lie2", Fraction(0))


@few
@given(made=in_time)
def test_what_is_drawn_has_t_and_reads_back(made: Hamiltonian) -> None:
    assert made.time_dependent
    assert Hamiltonian.parse(made.formula).exact == made.exact


@few
@given(made=hamiltonians(time_dependent=True, separable=True, bounded=True))
def test_separable_and_bounded_stay_so(made: Hamiltonian) -> None:
    assert canonical_field(made)[0].separable
    assert sympy.Poly(made.exact.diff(t).subs(p, 0), q).degree() == 1  # which the rest outgrows


@few
@given(made=hamiltonians(["polynomial"], time_dependent=True, degree=2))
def test_kinds_and_degree_are_kept_at_each_t(made: Hamiltonian) -> None:
    assert sympy.Poly(made.exact.subs(t, sympy.Rational(1, 3)), p, q).total_degree() <= 2


@pytest.mark.parametrize(("kinds", "degree"), [(["trigonometric"], 6), (["polynomial"], 3)])
def test_what_exceeds_them_is_drawn_where_it_is_allowed(kinds: list[str], degree: int) -> None:
    """The control of the test above: there is something to keep out."""

    def beyond(made: Hamiltonian) -> bool:
        driving = made.exact.diff(t)
        return driving.has(sympy.cos(q)) or driving.diff(q, 3) != 0

    quietly = settings(few, max_examples=1000, phases=[Phase.generate])
    assert find(hamiltonians(kinds, time_dependent=True, degree=degree), beyond, settings=quietly)


def test_bad_arguments_are_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="is not known of an H in time"):
        hamiltonians(time_dependent=True, bounded=False)
    with pytest.raises(InputError, match="time_dependent=1: must be True or False"):
        hamiltonians(time_dependent=1)  # type: ignore[arg-type]
