"""Steps that solve equations: what kernels compute against steps by hand, in each arithmetic."""

import math
import time
from fractions import Fraction
from itertools import pairwise
from typing import Any

import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q, plain
from tests.helpers.stepping.implicit_steps import (
    NONLINEAR,
    RADAU,
    TABLEAUS,
    by_hand,
    counted,
    kernel,
    plain_determinant,
    planted,
    step_map,
    steps,
)
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.step.lowering import MAX_UPDATES
from verify.runs.requested_run import run
from verify.schemes.maps.kinds.implicit_runge_kutta import by_equations, implicit_map
from verify.schemes.maps.step_map import StepMap
from verify.studies.separation.truncation_and_rounding import separate

AT = Fraction(3, 10), Fraction(1, 2)
H = Fraction(1, 10)
ARITHMETICS = [
    ("float64", 17), ("mpfr", 30), ("mpmath", 30), ("mpfr", 200), ("mpmath", 200),
]  # fmt: skip
each_scheme = pytest.mark.parametrize("name", TABLEAUS)
each_h = pytest.mark.parametrize("text", NONLINEAR.values(), ids=NONLINEAR.keys())
each_arithmetic = pytest.mark.parametrize(("arithmetic", "digits"), ARITHMETICS)


def units(arithmetic: str, digits: int) -> Fraction:
    return Fraction(1, 2**52) if arithmetic == "float64" else Fraction(1, 10**digits)


def apart(x: tuple[Fraction, ...], y: tuple[Fraction, ...]) -> Fraction:
    return max(abs(a - b) for a, b in zip(x, y, strict=True))


# -- the equations hold ---------------------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.sample(14)
@each_arithmetic
@each_h
@each_scheme
def test_a_step_is_that_of_the_equations_solved_by_hand(
    name: str, text: str, arithmetic: str, digits: int
) -> None:
    found = steps(step_map(name, text), arithmetic, digits, AT, H)
    true = by_hand(text, TABLEAUS[name], AT, H, digits)
    assert apart(found, true) < 8 * units(arithmetic, digits)
    assert apart(found, AT) > Fraction(1, 100), "the step moves"


def test_a_coefficient_that_is_off_by_very_little_makes_another_step() -> None:
    """The comparison above sees an error of 10^-25 at 30 digits."""
    wrong = planted(TABLEAUS["gauss4"], 0, 1, sympy.Rational(1, 10**25))
    made = implicit_map(Hamiltonian.parse(NONLINEAR["pendulum"]), wrong)
    true = by_hand(NONLINEAR["pendulum"], TABLEAUS["gauss4"], AT, H, 30)
    assert apart(steps(made, "mpfr", 30, AT, H), true) > 8 * units("mpfr", 30)


@pytest.mark.parametrize("text", ["p**2*(1 + q**2)/2 + q", "cos(p + q) + p**3", "exp(p*q) + p**2"])
@each_arithmetic
def test_symplectic_euler_satisfies_its_equations(text: str, arithmetic: str, digits: int) -> None:
    made = step_map("implicit-symplectic-euler", text)
    assert made.implicit
    p, q = steps(made, arithmetic, digits, AT, H)
    put = {P: sympy.Rational(*p.as_integer_ratio()), Q: sympy.Rational(*AT[1].as_integer_ratio())}
    slopes = [plain(text).diff(z).subs(put).evalf(digits + 20) for z in (Q, P)]
    gaps = (p - AT[0] + H * _fraction(slopes[0]), q - AT[1] - H * _fraction(slopes[1]))
    assert max(map(abs, gaps)) < 8 * units(arithmetic, digits)


def _fraction(x: Any) -> Fraction:
    rational = sympy.Rational(x)
    return Fraction(int(rational.p), int(rational.q))


@pytest.mark.parametrize("text", ["p**2/2 + 2*q**2", "p**2/2 + p*q/4 + q**2 + q", "p*q"])
@pytest.mark.parametrize("name", ["implicit-midpoint", "gauss4", "gauss6"])
def test_the_closed_form_of_a_quadratic_h_is_what_newton_finds(name: str, text: str) -> None:
    hamiltonian = Hamiltonian.parse(text)
    closed = implicit_map(hamiltonian, TABLEAUS[name])
    solved = by_equations(hamiltonian, TABLEAUS[name])
    assert solved.implicit
    assert not closed.implicit
    found = [steps(made, "mpfr", 50, AT, H) for made in (closed, solved)]
    # The ring writes a quotient by its partial fractions, which cancel in part.
    assert apart(*found) < Fraction(100, 10**50)
    assert apart(found[1], by_hand(text, TABLEAUS[name], AT, H, 50)) < Fraction(4, 10**50)
    assert apart(found[0], steps(step_map("lie2", text), "mpfr", 50, AT, H)) > Fraction(1, 10**6)


# -- the Jacobian ---------------------------------------------------------------------------------


def differences(made: StepMap, digits: int) -> Fraction:
    """det J by central differences, in which nothing is differentiated."""
    small = Fraction(1, 10 ** (digits // 3))
    ends = {
        sign: [steps(made, "mpfr", digits, (AT[0] + sign * a, AT[1] + sign * b), H)
               for a, b in ((small, 0), (0, small))]
        for sign in (1, -1)
    }  # fmt: skip
    entries = [
        [(x - y) / (2 * small) for x, y in zip(plus, minus, strict=True)]
        for plus, minus in zip(ends[1], ends[-1], strict=True)
    ]
    return entries[0][0] * entries[1][1] - entries[0][1] * entries[1][0]


@pytest.mark.sample(6)
@each_h
@pytest.mark.parametrize("name", [*TABLEAUS, "radau"])
def test_the_jacobian_is_the_one_of_finite_differences(name: str, text: str) -> None:
    tableau = RADAU if name == "radau" else TABLEAUS[name]
    made = implicit_map(Hamiltonian.parse(text), tableau)
    plain = plain_determinant(made, "mpfr", 60, AT, H)
    assert abs(plain - differences(made, 120)) < Fraction(1, 10**50)
    preserved = abs(plain - 1) < Fraction(1, 10**58)
    assert preserved is (name != "radau") is made.preserves_area


@each_arithmetic
@each_scheme
def test_the_determinant_is_1_up_to_rounding(name: str, arithmetic: str, digits: int) -> None:
    made = step_map(name, NONLINEAR["exponential"])
    gap = abs(plain_determinant(made, arithmetic, digits, AT, H) - 1)
    assert gap <= 20 * units(arithmetic, digits)


@pytest.mark.parametrize("place", [(0, 0), (0, 1), (1, 0), (2, 1)])
def test_a_planted_error_is_seen_in_the_determinant(place: tuple[int, int]) -> None:
    wrong = planted(TABLEAUS["gauss4"], *place, sympy.Rational(1, 10**11))
    made = implicit_map(Hamiltonian.parse(NONLINEAR["exponential"]), wrong)
    assert not made.preserves_area
    gap = abs(plain_determinant(made, "mpfr", 60, AT, H) - 1)
    assert Fraction(1, 10**20) < gap < Fraction(1, 10**10)


@each_scheme
def test_a_step_of_minus_h_undoes_that_of_h(name: str) -> None:
    made = step_map(name, NONLINEAR["exponential"])
    there = steps(made, "mpfr", 60, AT, H)
    assert apart(steps(made, "mpfr", 60, there, -H), AT) < Fraction(1, 10**58)
    other = implicit_map(Hamiltonian.parse(NONLINEAR["exponential"]), RADAU)
    there = steps(other, "mpfr", 60, AT, H)
    assert apart(steps(other, "mpfr", 60, there, -H), AT) > Fraction(1, 10**8)


# -- orders ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", ["pendulum", "duffing", "not separable"])
@pytest.mark.parametrize(
    ("name", "order"),
    [("implicit-midpoint", 2), ("gauss4", 4), ("gauss6", 6), ("implicit-symplectic-euler", 1)],
)
def test_errors_shrink_with_the_order_that_is_proved(name: str, order: int, case: str) -> None:
    text = NONLINEAR[case]
    counts = [64, 128, 256, 512] if order < 4 else [16, 32, 64, 128]
    true = steps(step_map("lie8", text), "mpfr", 50, AT, Fraction(1, 1024), 1024)
    made = step_map(name, text)
    errors = [apart(steps(made, "mpfr", 50, AT, Fraction(1, n), n), true) for n in counts]
    slopes = [math.log2(x / y) for x, y in pairwise(errors)]
    assert all(abs(slope - order) < 0.1 for slope in slopes), slopes


# -- Newton's method ------------------------------------------------------------------------------


@pytest.mark.sample(20)
@pytest.mark.parametrize(
    ("arithmetic", "digits", "most"), [("float64", 17, 4), ("mpfr", 30, 5), ("mpfr", 200, 8)]
)
@each_h
@pytest.mark.parametrize("name", [*TABLEAUS, "implicit-symplectic-euler"])
def test_few_updates_are_needed(
    name: str, text: str, arithmetic: str, digits: int, most: int
) -> None:
    made = step_map(name, text)
    count = 20  # the one with exp(p) goes to infinity at last
    needed = counted(made, arithmetic, digits, AT, Fraction(1, 20), count)
    assert needed <= most
    if made.implicit:
        assert needed >= 2, "they were counted"


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("arithmetic", ["float64", "mpfr", "mpmath"])
@pytest.mark.parametrize("name", [*TABLEAUS, "implicit-symplectic-euler"])
@pytest.mark.parametrize(
    "text", ["p**2*(1 + q**2)/2 + q**4/4 + exp(q)*p", "exp(p*q) + p**2/2 + exp(q**2)"]
)
def test_equations_without_a_solution_end_the_run_at_once(
    name: str, text: str, arithmetic: str
) -> None:
    begun = time.perf_counter()
    found = run(
        Hamiltonian.parse(text), name, q=3, p=2, step_size=50, steps=1000, arithmetic=arithmetic,
        observables=("lambda_plain",),
    )  # fmt: skip
    assert found.status in ("left range", "unresolved")
    assert time.perf_counter() - begun < 30
    if found.status == "left range":
        assert found.failed_step is not None
        assert 1 <= found.failed_step <= 1000


@pytest.mark.parametrize("arithmetic", ["float64", "mpfr", "mpmath"])
def test_an_equation_that_has_no_solution_is_told_with_its_step(arithmetic: str) -> None:
    """p' = p − h p'^2: with h p < −1/4 there is none, and it is so after the first step."""
    found = run(
        Hamiltonian.parse("q*p**2 + q"), "implicit-symplectic-euler", q=0, p="-0.3",
        step_size="1/4", steps=1000, arithmetic=arithmetic,
    )  # fmt: skip
    assert found.status == "left range"
    # p' + p'^2/4 + 1/4 = p: real solutions for p ≥ −3/4 only.
    p, taken = -0.3, 0
    while p >= -0.75:
        p, taken = -2 + math.sqrt(4 + 4 * (p - 0.25)), taken + 1
    assert found.failed_step == taken + 1


@pytest.mark.parametrize(("arithmetic", "digits"), ARITHMETICS)
def test_of_two_solutions_it_is_the_one_that_h_goes_to_0_with(arithmetic: str, digits: int) -> None:
    """p' + p'^2 + 1 = p at p = 10: from p − h H_q = −91 Newton's method goes to the wrong one."""
    made = step_map("implicit-symplectic-euler", "q*p**2 + q")
    p, _ = steps(made, arithmetic, digits, (Fraction(10), Fraction(0)), Fraction(1))
    true = _fraction(((sympy.sqrt(37) - 1) / 2).evalf(digits + 10))
    assert abs(p - true) < 8 * units(arithmetic, digits)
    assert abs(p + 1 + true) > 5, "not the other one"


def test_the_cap_is_a_small_number() -> None:
    assert MAX_UPDATES <= 25


# -- runs -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("arithmetic", ["fixed", "ball"])
def test_an_arithmetic_that_solves_no_equations_says_so(arithmetic: str) -> None:
    found = run(
        Hamiltonian.parse(NONLINEAR["pendulum"]), "gauss4", q=1, p=0, step_size="0.1", steps=10,
        arithmetic=arithmetic, digits=30,
    )  # fmt: skip
    assert (found.arithmetic, found.status) == ("mpfr", "finished")
    assert found.fallback == f"{arithmetic} solves no equations"
    assert found.error_kind == "estimated"


@pytest.mark.parametrize("name", ["gauss4", "implicit-symplectic-euler"])
def test_the_bound_of_a_float64_run_holds(name: str) -> None:
    at: dict[str, Any] = {"q": "0.5", "p": "0.3", "step_size": "0.1", "steps": 500}
    text = NONLINEAR["not separable"]
    found = run(Hamiltonian.parse(text), name, **at, observables=("lambda_plain",))
    exact = run(Hamiltonian.parse(text), name, **at, arithmetic="mpfr", digits=40,
                observables=("lambda_plain",))  # fmt: skip
    for key in ("p", "q", "lambda_plain"):
        gap = abs(Fraction(found.values[key].value) - Fraction(exact.values[key].value))
        assert gap <= Fraction(found.values[key].bound)
    assert found.error_kind == "estimated"


def test_a_long_compiled_run_goes_the_way_of_the_interpreted_one() -> None:
    """Beyond 10,000 steps LLVM takes over, with the same bits."""
    text = NONLINEAR["duffing"]
    hamiltonian, tableau = Hamiltonian.parse(text), TABLEAUS["gauss4"]
    made, again = (implicit_map.__wrapped__(hamiltonian, tableau) for _ in "12")
    interpreted = kernel(made, "float64", 17).function
    compiled = kernel(again, "float64", 17).function
    state = interpreted(1000, 0.05, 0.3, 0.5)
    first = compiled(9_999, 0.05, 0.3, 0.5)
    assert compiled(1001, 0.05, *first[1:])[0] == 1001
    assert compiled(1000, 0.05, 0.3, 0.5) == state


def test_what_float64_loses_is_separated_where_equations_are_solved() -> None:
    found = separate(
        Hamiltonian.parse(NONLINEAR["not separable"]), "gauss4", q="0.5", p="0.3",
        step_size="0.1", steps=200, digits=6,
    )  # fmt: skip
    own = run(
        Hamiltonian.parse(NONLINEAR["not separable"]), "gauss4", q="0.5", p="0.3",
        step_size="0.1", steps=200, observables=("lambda_plain",),
    )  # fmt: skip
    assert found.status == "finished"
    assert found.plain is not None
    assert float(found.plain.parts.truncation.value) == 0
    assert float(found.plain.parts.lambda_working.value) != 0
    working = Fraction(found.plain.parts.lambda_working.value)
    gap = abs(working - Fraction(own.values["lambda_plain"].value))
    assert gap <= Fraction(own.values["lambda_plain"].bound)
