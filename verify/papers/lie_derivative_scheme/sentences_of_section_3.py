"""Sentences of Sections 3 and 4.1 beside their equations: of errors, and of single numbers."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import flint
import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import decimal, text
from verify.papers.argument import (
    BALLS,
    NUMBERS,
    Argument,
    Check,
    proof,
    refutation,
    same,
    vanishes,
)
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.exact_maps import Areas, RationalPoint, areas, map_from_texts, next_point, value
from verify.papers.lie_derivative_scheme import examples
from verify.papers.lie_derivative_scheme.convergence import STEPS
from verify.papers.lie_derivative_scheme.error_measures import mean_of_squares
from verify.schemes.methods.taylor.lie import lie_map

EULER = ("p - h*q", "q + h*p - h**2*q")  # symplectic Euler for H = (p² + q²)/2
UNEVEN = ("-p*(1 + (q + 1/20)/10**11)", "-q")  # its ΔJ is 10⁻¹¹ (q + 1/20), whatever h is
START = RationalPoint(p=Fraction(1), q=Fraction(-1, 20))
_POINT_ONE = Fraction(1, 10)


def mse_quantifies() -> Argument:
    """Prove that MSE(J) measures how far the determinants are from 1."""
    return proof(
        """
        √MSE is the root mean square of det `J_k` − 1 over [t₀, `t_end`], and no |det `J_k` − 1|
        exceeds √(N MSE)

        - The true value of det `J_k` is 1 and ``MSE = (1/N) Σ_{k} (det J_k − 1)^2``.
          [mean_of_squares]
        - One term of a sum of squares is at most the sum: |det `J_k` − 1|² ≤ N MSE.
        """,
        mean_of_squares=mean_of_squares(),
    )


def mse_quantifies_solution(formulas: Sequence[str] = EULER) -> Argument:
    """Refute it for the solution: symplectic Euler for the oscillator has MSE = 0, error O(h)."""
    step_map = map_from_texts(*formulas)
    zero = same("symplectic Euler, H = (p² + q²)/2: ΔJ", [step_map.delta_j], ("p", "q", "h"))
    errors = [_error_at_1(formulas, n) for n in STEPS]
    return refutation(
        f"""
        symplectic Euler has det `J_k` = 1 and MSE = 0 whatever h is, while its solution is off by
        {", ".join(error.value for error in errors)} at t = 1 for the oscillator with h =
        {", ".join(text(Fraction(1, n)) for n in STEPS)}

        Let the calculated values be those of (p, q).

        - For symplectic Euler (Eq. 24, 32) ΔJ = 0 at every point, so MSE = 0. [zero]
        - For H = (p² + q²)/2 from (q, p) = (1, 0) its error at t = 1 is about 0.42 h. [errors]
        """,
        zero=zero,
        errors=errors,
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
    return proof(
        """
        for both systems ΔJ of lie2 is an analytic function of (p, q) that is not identically 0, for
        any h > 0: it is 0 on a set of measure 0 alone

        - For δ ≠ 0, h > 0 ΔJ of lie2 is not identically 0 in (p, q): its part that is proportional
          to p is not. [part_in_p]
        - Zeros of an analytic function that is not 0 everywhere have measure 0.
        """,
        part_in_p=map(_part_in_p, examples.SYSTEMS),
    )


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
    return refutation(
        f"""
        for the Duffing oscillator with δ = 1 the step from q = {text(q)}, p = −4h/3 has ΔJ = 0, as
        those have from every point of the curve 12pq = −h (1 + 3q²)²

        - ΔJ = 3h³pq + `h⁴ (1 + 3q²)²/4` is 0 on this curve. [vanishing]
        """,
        vanishing=vanishing,
    )


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
    return refutation(
        """
        criteria 2 and 4 speak of h → 0, and a number at one h says nothing of that: a map that does
        not depend on h at all, with ΔJ = 10⁻¹¹ (1/20 ± 1), has these very numbers at h = 0.001 and
        satisfies neither

        - p' = −p (1 + 10⁻¹¹ (q + 1/20)), q' = −q from (p, q) = (0, 1) alternates between two ΔJ,
          about ±10⁻¹¹, whatever h is: |ΔJ| is about 10⁻¹¹ and no o(h). [returns_after_two]
        - Over [0, 20000] with h = 0.001 its Λ is about 10⁻⁵. [after_all_steps]
        - After N = T/h steps 1 + Λ is a fixed number above 1 to the power N/2, which does not tend
          to 1 as h → 0. [two_together]

        That lie2 satisfies both criteria is true, and shown by Eq. 21.
        """,
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
    return refutation(
        f"""
        for the Duffing oscillator (δ = 1, lie2, h = {text(h)}) from (p, q) = {start}, |Λ| after 1,
        2, … steps is {totals_text}, exact but for the rounding of what is shown; the leading part
        of Λ is a boundary term that does not grow

        - `ΔJ_k` has both signs, so its product need not grow: from (p, q) = (1, −1/20) the Duffing
          oscillator crosses q = 0, where pq changes its sign and with it 3h³δpq, and |Λ| falls
          within two steps. [falls]
        - It is not a matter of a few steps. For lie2 and every smooth H the leading term of ΔJ is a
          derivative along the flow: ``ΔJ = (h^3/2) X(det Hess H) + O(h^4)``. [telescopes,
          Theorems.lie_telescopes_in_plane_for_even, Theorems.determinant_of_lie_in_plane]
        - On a fixed [0, T] its sum is therefore a boundary term, with D = det Hess H: ``Λ =
          (h^2/2)(D(z(T)) − D(z(0))) + O(h^3)``. On a periodic orbit it returns to O(h³) after every
          period.

        It is the next order that may grow with T.
        """,
        falls=falls,
        telescopes=telescopes,
    )
