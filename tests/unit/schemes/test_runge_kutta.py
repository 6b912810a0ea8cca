"""Explicit Runge–Kutta schemes: the map in stages against plain arithmetic, their proofs and runs.

The oracle shares no code with `verify`: sympy differentiates H as it is written, and the stages and
their derivatives are followed by hand in whatever numbers they are given.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import mpmath
import pytest
import sympy

from tests.helpers.sampled.formulas import P, Q, plain
from verify import arithmetic, schemes
from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import KernelWriter
from verify.proof.order_for_one_h import prove
from verify.proof.proof_for_one_h import Proof
from verify.runs.requested_run import run
from verify.runs.step_bounds import StepDerivatives
from verify.schemes.conditions.every_hamiltonian import RungeKutta
from verify.schemes.maps.ball_algebra import step_in_balls
from verify.schemes.maps.kinds.explicit_runge_kutta import build
from verify.schemes.maps.step_map import StepMap
from verify.verdict import Verdict

ZERO, HALF, ONE = Fraction(0), Fraction(1, 2), Fraction(1)
CLASSICAL = RungeKutta(
    ((), (HALF,), (ZERO, HALF), (ZERO, ZERO, ONE)), (ONE / 6, ONE / 3, ONE / 3, ONE / 6)
)
TABLEAUS = {"rk4": CLASSICAL, "explicit-midpoint": RungeKutta(((), (HALF,)), (ZERO, ONE))}
SYSTEMS = {
    "duffing": "p**2/2 + q**2/2 + (3/4)*q**4/4",
    "pendulum": "p**2/2 - cos(q)",
    "polynomial, not separable": "p**2*q**3/3 - p*q/5 + q",
    "symmetric": "(p**2 + q**2)**2/4",
    "quotient": "p**2/(2*(1 + q**2))",
    "transcendental, not separable": "sqrt(1 + p**2)*exp(q/4) + cos(p*q)/2",
    "quarter root": "(1 + p**2 + q**2)**(1/4)",
    "logarithm": "p**2/2 + log(cosh(q))",
}
TOO_LONG = {  # for a closed form
    "rk4": {
        "polynomial, not separable", "symmetric", "quotient", "quarter root",
        "transcendental, not separable",
    },
    "explicit-midpoint": {"transcendental, not separable"},
}  # fmt: skip
every_system = pytest.mark.parametrize("text", SYSTEMS.values(), ids=SYSTEMS.keys())
every_scheme = pytest.mark.parametrize("name", TABLEAUS)
AT = {"p": Fraction(3, 7), "q": Fraction(5, 11), "h": Fraction(1, 9)}
Vector = Sequence[Any]


class ByHand:
    """One step and its Jacobian in numbers of any kind, for H as sympy reads it."""

    def __init__(
        self,
        text: str,
        tableau: RungeKutta,
        number: Callable[[Fraction], Any],
        functions: str = "mpmath",
    ) -> None:
        field = [-plain(text).diff(Q), plain(text).diff(P)]
        jacobian = [x.diff(y) for x in field for y in (P, Q)]
        self.field = sympy.lambdify((P, Q), [*field, *jacobian], functions)
        self.rows = [[number(x) for x in row] for row in (*tableau.rows, tableau.weights)]

    def step(self, p: Any, q: Any, h: Any) -> tuple[Any, Any, Any]:
        """p', q' and ΔJ."""
        z, m = self.with_jacobian(p, q, h)
        return z[0], z[1], m[0] * m[3] - m[1] * m[2] - 1

    def with_jacobian(self, p: Any, q: Any, h: Any) -> tuple[Vector, Vector]:
        """(p', q') and J, row by row."""
        slopes: list[tuple[Vector, Vector]] = []
        for row in self.rows:
            z, m = [p, q], [1, 0, 0, 1]
            for w, (k, dk) in zip(row, slopes, strict=True):
                z = [x + h * w * y for x, y in zip(z, k, strict=True)]
                m = [x + h * w * y for x, y in zip(m, dk, strict=True)]
            if len(slopes) == len(self.rows) - 1:
                break
            k_p, k_q, a, b, c, d = self.field(*z)
            moved = [a * m[0] + b * m[2], a * m[1] + b * m[3]]
            moved += [c * m[0] + d * m[2], c * m[1] + d * m[3]]
            slopes.append(([k_p, k_q], moved))
        return z, m


def in_balls(step_map: StepMap) -> tuple[list[Any], Any]:
    """z' − z and J − 1 at `AT`, stage by stage."""
    assert step_map.step is not None
    with working_precision(256):
        point = {name: rational_ball(AT[name]) for name in ("p", "q")}
        return step_in_balls(step_map.field, step_map.step, point, rational_ball(AT["h"]))


def to_mpf(x: Fraction) -> Any:
    return mpmath.mpf(x.numerator) / x.denominator


def proof_of(text: str, tableau: RungeKutta, name: str) -> Proof:
    return prove(build(tableau, Hamiltonian.parse(text)), schemes.get(name))


# -- tableaus ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rows", "weights"),
    [
        (((), (HALF,)), (ONE,)),
        (((HALF,), (HALF,)), (ZERO, ONE)),
        (((), (HALF, HALF)), (ZERO, ONE)),
        (((), (HALF,)), (HALF, ONE)),
    ],
)
def test_a_tableau_that_does_not_fit_together_is_refused(
    rows: tuple[tuple[Fraction, ...], ...], weights: tuple[Fraction, ...]
) -> None:
    with pytest.raises(ValueError, match="weight"):
        RungeKutta(rows, weights)


# -- the map ----------------------------------------------------------------------------------


@every_scheme
@every_system
def test_the_map_and_delta_j_are_those_of_the_stages_by_hand(text: str, name: str) -> None:
    changes, slopes = in_balls(schemes.get(name).step_map(Hamiltonian.parse(text)))
    with mpmath.workdps(70), working_precision(256):
        by_hand = ByHand(text, TABLEAUS[name], to_mpf).step(*map(to_mpf, AT.values()))
        moved = [x + rational_ball(AT[n]) for x, n in zip(changes, "pq", strict=True)]
        delta_j = slopes.trace() + slopes.det()
        for ours, theirs in zip((*moved, delta_j), by_hand, strict=True):
            ball = mpmath.mpf(ours.mid().str(65, radius=False))
            assert abs(ball - theirs) < mpmath.mpf(10) ** -60


@pytest.mark.left_to_ci
@pytest.mark.sample(10)
@every_scheme
@every_system
def test_the_jacobian_is_that_by_hand_and_a_closed_forms_too(text: str, name: str) -> None:
    step_map = schemes.get(name).step_map(Hamiltonian.parse(text))
    _, slopes = in_balls(step_map)
    whole = step_map.closed
    with mpmath.workdps(70), working_precision(256):
        entries = [x + (k in (0, 3)) for k, x in enumerate(slopes.entries())]
        _, by_hand = ByHand(text, TABLEAUS[name], to_mpf).with_jacobian(*map(to_mpf, AT.values()))
        for ours, theirs in zip(entries, by_hand, strict=True):
            assert ours.rad() < 1e-50
            ball = mpmath.mpf(ours.mid().str(65, radius=False))
            assert abs(ball - theirs) < mpmath.mpf(10) ** -60
        if whole is not None:
            written = [enclose(whole.ring, x, AT, 256) for row in whole.jacobian for x in row]
            assert all(x.overlaps(y) for x, y in zip(entries, written, strict=True))
    assert (whole is None) == (text in {SYSTEMS[long] for long in TOO_LONG[name]})


def test_a_kernel_evaluates_each_stage_once() -> None:
    step_map = schemes.get("rk4").step_map(Hamiltonian.parse(SYSTEMS["pendulum"]))
    made = replace(arithmetic.get("mpmath", 30), compile=lambda *_: lambda *_: ())
    source = KernelWriter(step_map, made, frozenset({"lambda"}), compensated=False).kernel().source
    assert source.count("cos_sin(") == 4


# -- proofs -----------------------------------------------------------------------------------

ORDERS = {  # of ΔJ; a kinetic energy p²/2 makes rk4's fifth order vanish
    ("rk4", "duffing"): 6,
    ("rk4", "pendulum"): 6,
    ("rk4", "logarithm"): 6,
    ("rk4", "polynomial, not separable"): 5,
    ("rk4", "quotient"): 5,
    ("explicit-midpoint", "duffing"): 3,
    ("explicit-midpoint", "symmetric"): 4,
}


@pytest.mark.parametrize(("name", "system"), ORDERS)
def test_the_leading_term_of_delta_j_is_its_limit(name: str, system: str) -> None:
    text = SYSTEMS[system]
    proof = proof_of(text, TABLEAUS[name], name)
    assert proof.verdict is Verdict.PROVED
    assert (proof.order, proof.convergence_order) == (ORDERS[name, system], schemes.get(name).order)
    with mpmath.workdps(300):
        h = mpmath.mpf(10) ** -30
        p, q = (to_mpf(AT[n]) for n in ("p", "q"))
        ratio = ByHand(text, TABLEAUS[name], to_mpf).step(p, q, h)[2] / h**proof.order
        expected = proof.leading.subs({P: sympy.Rational(3, 7), Q: sympy.Rational(5, 11)}).evalf(60)
        assert abs(ratio - mpmath.mpf(str(expected))) < mpmath.mpf(10) ** -25


WRONG = {
    "a weight": (CLASSICAL.rows, (ONE / 6, ONE / 6, ONE / 2, ONE / 6)),
    "a row": (((), (HALF,), (ONE / 4, ONE / 4), (ZERO, ZERO, ONE)), CLASSICAL.weights),
    "the last row": (((), (HALF,), (ZERO, HALF), (ZERO, HALF, HALF)), CLASSICAL.weights),
}


@pytest.mark.parametrize(("rows", "weights"), WRONG.values(), ids=WRONG.keys())
def test_a_wrong_coefficient_is_refuted(
    rows: tuple[tuple[Fraction, ...], ...], weights: tuple[Fraction, ...]
) -> None:
    proof = proof_of(SYSTEMS["pendulum"], RungeKutta(rows, weights), "rk4")
    assert proof.verdict is Verdict.REFUTED
    assert "rk4 claims order 4" in proof.reason


@pytest.mark.parametrize("text", ["p", "p**3 + sin(p)", "exp(q)", "cos(p + 2*q)"])
def test_the_flow_of_a_shear_is_seen_to_preserve_area(text: str) -> None:
    proof = proof_of(text, CLASSICAL, "rk4")
    assert (proof.verdict, proof.area_preserving) == (Verdict.PROVED, True)
    assert proof.delta_j == 0
    assert proof.convergence_order is None


def test_a_closed_form_that_is_too_large_is_left_out_and_the_order_is_proved() -> None:
    proof = proof_of(SYSTEMS["transcendental, not separable"], CLASSICAL, "rk4")
    assert (proof.verdict, proof.order, proof.delta_j) == (Verdict.PROVED, 5, None)


def test_a_quadratic_hamiltonian_has_the_closed_form_of_the_truncated_exponential() -> None:
    harmonic = Hamiltonian.parse("p**2/2 + omega**2*q**2/2")
    rk4, lie4 = (prove(schemes.get(name).step_map(harmonic)) for name in ("rk4", "lie4"))
    assert rk4.delta_j is not None
    assert sympy.expand(rk4.delta_j - lie4.delta_j) == 0


def test_a_parameter_stays_a_symbol_in_the_closed_form() -> None:
    proof = proof_of("p**2/2 + q**2/2 + delta*q**4/4", CLASSICAL, "rk4")
    text = "p**2/2 + q**2/2 + 2*q**4/4"  # whole numbers, which sympy's code leaves exact
    values = {"p": AT["p"], "q": AT["q"], "h": AT["h"], "delta": Fraction(2)}
    assert proof.delta_j is not None
    found = proof.delta_j.subs({plain(n): sympy.Rational(str(x)) for n, x in values.items()})
    p, q, h = (sympy.Rational(str(x)) for x in AT.values())
    by_hand = ByHand(text, CLASSICAL, lambda x: sympy.Rational(str(x)), "sympy")
    assert found == by_hand.step(p, q, h)[2]


# -- runs -------------------------------------------------------------------------------------


@pytest.mark.sample(3)
@every_scheme
@pytest.mark.parametrize("arithmetic_name", ["fixed", "mpfr", "ball", "float64"])
@pytest.mark.parametrize("text", [SYSTEMS["duffing"], SYSTEMS["transcendental, not separable"]])
def test_a_run_is_the_one_by_hand_within_its_bound(
    text: str, arithmetic_name: str, name: str
) -> None:
    steps, h = 40, Fraction(1, 20)
    found = run(
        Hamiltonian.parse(text), name, q="1/2", p="3/4", step_size="1/20", steps=steps, digits=25,
        arithmetic=arithmetic_name, observables=("lambda", "mse"),
    )  # fmt: skip
    with mpmath.workdps(70):
        by_hand = ByHand(text, TABLEAUS[name], to_mpf)
        p, q, lam, mse = mpmath.mpf(3) / 4, mpmath.mpf(1) / 2, mpmath.mpf(0), mpmath.mpf(0)
        for _ in range(steps):
            p, q, delta_j = by_hand.step(p, q, to_mpf(h))
            lam, mse = lam + delta_j + lam * delta_j, mse + delta_j**2 / steps
        for key, true in {"p": p, "q": q, "lambda": lam, "mse": mse}.items():
            value = found.values[key]
            assert abs(mpmath.mpf(value.value) - true) <= mpmath.mpf(value.bound) * 1.01, key
    assert found.error_kind == "enclosed"


@every_system
def test_the_bounds_of_a_run_need_no_closed_form(text: str) -> None:
    assert (
        StepDerivatives.from_scheme(Hamiltonian.parse(text), "rk4", volume=True, form=False)
        is not None
    )
