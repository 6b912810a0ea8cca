"""Sentences of Sections 3 and 4.1 beside their equations: of errors, and of single numbers."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import flint
import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import decimal, text
from verify.papers.argument import BALLS, NUMBERS, Argument, ArgumentTexts, Check, same, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.exact_maps import Areas, RationalPoint, areas, map_from_texts, next_point, value
from verify.papers.lie_derivative_scheme import examples
from verify.papers.lie_derivative_scheme.convergence import STEPS
from verify.papers.lie_derivative_scheme.error_measures import mean_of_squares
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

EULER = ("p - h*q", "q + h*p - h**2*q")  # symplectic Euler for H = (p² + q²)/2
UNEVEN = ("-p*(1 + (q + 1/20)/10**11)", "-q")  # its ΔJ is 10⁻¹¹ (q + 1/20), whatever h is
START = RationalPoint(p=Fraction(1), q=Fraction(-1, 20))
_POINT_ONE = Fraction(1, 10)


def mse_quantifies() -> Argument:
    """Prove that MSE(J) measures how far the determinants are from 1."""
    return _TEXTS.proof("mse_quantifies", mean_of_squares=mean_of_squares())


def mse_quantifies_solution(formulas: Sequence[str] = EULER) -> Argument:
    """Refute it for the solution: symplectic Euler for the oscillator has MSE = 0, error O(h)."""
    step_map = map_from_texts(*formulas)
    zero = same("symplectic Euler, H = (p² + q²)/2: ΔJ", [step_map.delta_j], ("p", "q", "h"))
    errors = [_error_at_1(formulas, n) for n in STEPS]
    return _TEXTS.refutation(
        "mse_quantifies_solution",
        zero=zero,
        errors=errors,
        error_values=", ".join(error.value for error in errors),
        step_sizes=", ".join(text(Fraction(1, n)) for n in STEPS),
    )


def _error_at_1(formulas: Sequence[str], steps: int) -> Check:
    """Check the error after N steps of 1/N, in balls; the map is linear."""
    jacobian = map_from_texts(*formulas).jacobian
    h = Fraction(1, steps)
    a, b, c, d = (value(x, RationalPoint(Fraction(0), Fraction(0)), h) for x in jacobian)
    with examples.enclosures():
        entries = [rational_ball(x) for x in (a, b, c, d)]
        matrix = flint.arb_mat(2, 2, entries) ** steps
        p, q = matrix[0, 1], matrix[1, 1]  # from (p, q) = (0, 1)
        one = flint.arb(1)
        error = ((p + one.sin()) ** 2 + (q - one.cos()) ** 2).sqrt()
        share = error * steps
        holds, texts = bool(share > 0.4) and bool(share < 0.5), error.mid().str(3, radius=False)
    return Check(
        f"symplectic Euler, oscillator, h = {text(h)}: the error at t = 1 lies between 0.4 h and "
        "0.5 h",
        holds,
        f"`{texts}`",
        BALLS,
    )


def errors_in_every_step() -> Argument:
    """Prove that ΔJ of lie2 is not 0 at almost every state of either system."""
    return _TEXTS.proof("errors_in_every_step", part_in_p=map(_part_in_p, examples.SYSTEMS))


def _part_in_p(name: str) -> Check:
    """Check that ∂ΔJ/∂p of lie2 is not identically 0, for δ = 1."""

    parameters = {"delta": 1} if name == "duffing" else {}
    slope = lie_map(examples.with_symbols(name).with_values(parameters), 2).delta_j
    slope = sympy.simplify(sympy.diff(slope, P))
    return Check(f"{name}: ∂ΔJ/∂p of lie2", slope != 0, f"`{slope}`")


def errors_in_every_step_exactly(
    q: Fraction = Fraction(1), share: Fraction = Fraction(-4, 3)
) -> Argument:
    """Refute it exactly, by a curve of the Duffing oscillator with ΔJ = 0; `share`: p/h on it."""
    step_map = examples.duffing_step()
    substitution = {
        P: sympy.Rational(share.numerator, share.denominator) * H_STEP,
        Q: sympy.Rational(q),
    }
    vanishing = same(
        f"Duffing, δ = 1, lie2: ΔJ at q = {text(q)}, p = `{text(share)} h`",
        [sympy.expand(step_map.delta_j.subs(substitution, simultaneous=True))],
        ("h",),
    )
    return _TEXTS.refutation("errors_in_every_step_exactly", vanishing=vanishing, q=text(q))


# -- Section 4.1 -----------------------------------------------------------------------------------


def duffing_criteria_inference(
    formulas: Sequence[str] = UNEVEN, steps: int = 20_000_000
) -> Argument:
    """Refute the inference by a map with the numbers of Figure 3 that fails both criteria."""
    step_map = map_from_texts(*formulas)
    points = [RationalPoint(Fraction(0), Fraction(1))]
    points += [next_point(step_map, points[0], _POINT_ONE)]
    defects = [value(step_map.delta_j, point, _POINT_ONE) for point in points]
    # The map has period 2 in z, so that Λ after N steps is a power of the ΔJ of two steps.
    returns = next_point(step_map, points[1], _POINT_ONE) == points[0]
    size, pair = max(map(abs, defects)), (1 + defects[0]) * (1 + defects[1]) - 1
    with examples.enclosures():
        growth = (1 + rational_ball(pair)) ** (steps // 2) - 1
        near = bool(growth > 5e-6) and bool(growth < 2e-5)
        text_of_growth = growth.mid().str(3, radius=False)
    return _TEXTS.refutation(
        "duffing_criteria_inference",
        returns_after_two=Check(
            "the map: it returns after two steps, and max |ΔJ|",
            returns and H_STEP not in step_map.delta_j.free_symbols and 5e-12 < size < 2e-11,
            f"`{decimal(size, 3)}`",
            NUMBERS,
        ),
        after_all_steps=Check(
            f"the map: Λ after {steps} steps", near, f"`{text_of_growth}`", BALLS
        ),
        two_together=Check(
            "the map: ΔJ of two steps together is positive",
            pair > 0,
            f"`{decimal(pair, 3)}`",
            NUMBERS,
        ),
    )


# -- “the total error of the mapping will keep increasing” -----------------------------------------


def total_error_increases(
    start: RationalPoint = START, h: Fraction = Fraction(1, 10), steps: int = 3
) -> Argument:
    """Refute that |Λ| increases with the steps, for the Duffing oscillator and every even η."""
    delta_j = areas(examples.duffing_step(), start, h, steps).delta_j
    totals = [abs(Areas(delta_j[:n]).lam) for n in range(1, steps + 1)]
    totals_text = ", ".join(f"`{decimal(x, 4)}`" for x in totals)
    flow = flow_of_every_hamiltonian(4)
    falls = Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, from (p, q) = {start}: |Λ| after n steps falls, "
        f"n = 1 … {steps}",
        any(later < earlier for earlier, later in pairwise(totals)),
        totals_text,
        NUMBERS,
    )
    telescopes = vanishes(
        "the coefficient of h³ in ΔJ of lie2 is X·G for a generic H, with G = det Hess H/2",
        flow.delta_j_gaps(2, h3=flow.derive(flow.hessian_determinant / 2))[2],
    )
    return _TEXTS.refutation(
        "total_error_increases",
        falls=falls,
        telescopes=telescopes,
        h=text(h),
        start=str(start),
        totals=totals_text,
    )
