"""Eq. 9, the Lipschitz condition by components, and L_p = ‖J_k‖₂: neither holds as printed."""

from collections.abc import Sequence
from fractions import Fraction

import flint

from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.claims.theorems.argument import Argument, Check, concluded
from verify.claims.theorems.exact_maps import Point, jacobian, next_point
from verify.claims.theorems.oscillator import PRECISION, errors, factor
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.methods.taylor.lie import lie_map
from verify.verdict import Verdict

PAIR = (Point(p=Fraction(0), q=Fraction(0)), Point(p=Fraction(0), q=Fraction(1)))
STRETCHED = Point(p=Fraction(0), q=Fraction(2))
STEP_SIZES = (Fraction(1, 10), Fraction(1, 100), Fraction(1, 1000))
LATEST = 4  # runs are looked at up to this time


def _duffing(delta: int = 1) -> Hamiltonian:
    return systems.get("duffing").hamiltonian().with_values({"delta": delta})


def eq_9(pair: tuple[Point, Point] = PAIR) -> Argument:
    """Eq. 9 by a pair of points with equal p, and along a run of the oscillator."""
    h = Fraction(1, 10)
    step = lie_map(_duffing(), 2)
    ends = [next_point(step, point, h) for point in pair]
    left, right = abs(ends[1].p - ends[0].p), abs(pair[1].p - pair[0].p)
    along = [_along_a_run(size) for size in STEP_SIZES]
    checks = [
        Check(
            f"Duffing, δ = 1, lie2, h = 0.1, from (p, q) = {pair[0]} and {pair[1]}: |p̃ − p| "
            "before "
            "and after the step",
            right == 0 and left > 0,
            f"{text(right)} and {text(left)}",
        ),
        *along,
    ]
    return concluded(
        "eq-9",
        Verdict.REFUTED,
        f"for the Duffing oscillator (δ = 1, h = 0.1) two points with equal p and q = "
        f"{text(pair[0].q)}, {text(pair[1].q)} have |p̃ − p| = {text(left)} after one step, "
        "where the "
        "right side is 0 for every `L_p`; it holds for lieη, any H and all small h only if `H_pp` "
        "= 0 and `H_qq` = 0",
        """The right side has the p-difference alone, while `p_{k+1}` depends on `q_k` as well. Take
        two points with the same p and different q: the right side is 0 whatever `L_p` is, and the
        left side is |p'(p, q₁) − p'(p, q₂)|. For the Duffing oscillator with δ = 1 and lie2, p' = p
        − h(q + q³) − (h²/2) p (1 + 3q²), and from (p, q) = (0, 0) and (0, 1) the left side is 2h >
        0. For a general H: if Eq. 9 holds for all pairs of points of a rectangle and for all small
        h, with whatever constants, then p' does not depend on q there, for every h; p' is a
        polynomial in h whose coefficient of h is −`H_q`, so `H_qq` = 0; and likewise `H_pp` = 0
        from the line of q. Thus H = a pq + b p + c q + d. Conversely both components decouple for
        such an H, and Eq. 9 holds with `L_p` = `L_q` = (`e^(|a|h₀)` − 1)/h₀ for h ≤ h₀. It is no
        way out that `z̄_k` and `z_k` are not any two points but belong to an exact solution and to
        the run that starts on it. For the oscillator H = (p² + q²)/2 from (q, p) = (1, 0) the error
        of lie2 at time t is (t h²/6) (sin t, cos t) + O(h³) in (q, p): it turns with the solution,
        by an angle h in a step. In the step after its p-component has changed sign near t = π/2
        that component grows by a factor of 2 − O(h) at least, so that `L_p` ≥ (1 − O(h))/h: no
        constant will do (see the table; with `p̄_k` on the right, which Eq. 8 and 10 need, and with
        `p̃_k` as printed). What holds is the inequality in a norm of the plane: |Φ(z̄) − Φ(z)| ≤ (1
        + hL) |z̄ − z|, or by components |`p̃_{k+1}` − `p_{k+1}`| ≤ (1 + hL) |`p̄_k` − `p_k`| + hL
        |`q̄_k` − `q_k`|; with either, the conclusion of Section 2.2 stands. ∎""",
        checks,
    )


def _along_a_run(h: Fraction) -> Check:
    """The greatest L_p that one step of the run asks for, for both readings of the right side."""
    steps = int(LATEST / h)
    with working_precision(PRECISION):
        error, scheme = errors(2, h, steps), factor(2, h)
        size = 1 / float(h)
        barred = _largest([(scheme * e).imag for e in error], [e.imag for e in error], size)
        stepped = [(scheme * e).imag for e in error]
        literal = _largest(stepped[1:], stepped[:-1], size)
    return Check(
        f"oscillator from (q, p) = (1, 0), lie2, h = {text(h)}, t ≤ {LATEST}: the `L_p` that a "
        "step of the run asks for, with `p̄_k` and with `p̃_k` on the right, is above 1/h",
        min(barred, literal) > size,
        f"`{barred:.3g}` and `{literal:.3g}`",
    )


def _largest(left: Sequence[flint.arb], right: Sequence[flint.arb], scale: float) -> float:
    """A lower bound of the greatest (left/right − 1)/h over the steps where right is not 0."""
    known = [
        float((abs(x) / abs(y)).lower())
        for x, y in zip(left, right, strict=True)
        if not y.contains(0)
    ]
    return (max(known) - 1) * scale


def two_norm(point: Point = STRETCHED, h: Fraction = Fraction(1, 10)) -> Argument:
    """L_p = ‖J_k‖₂ in Eq. 9: refuted at a point where ‖J‖₂ > 1 + h ‖J‖₂ is exact."""
    a, b, c, d = jacobian(lie_map(_duffing(), 2), point, h)
    # With |Jv| ≤ ‖J‖₂ |v| for v = (1, −1), ‖J‖₂ (1 − h) > 1 follows from |Jv|² (1 − h)² > |v|².
    stretch = ((a - b) ** 2 + (c - d) ** 2) / 2
    check = Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, (p, q) = {point}: ‖J v‖²/‖v‖² for v = (1, −1), "
        "times "
        "(1 − h)², exceeds 1",
        stretch * (1 - h) ** 2 > 1,
        text(stretch * (1 - h) ** 2),
    )
    return concluded(
        "two-norm",
        Verdict.REFUTED,
        f"a map with ‖J‖₂ > 1 + h‖J‖₂ has no Lipschitz constant 1 + h‖J‖₂, and the Duffing step is "
        f"one: at (p, q) = {point}, h = {text(h)}, (1 − h)² ‖J‖₂² ≥ {text(stretch * (1 - h) ** 2)}",
        """‖J‖₂ is the local Lipschitz constant of the step map itself, Φ, whose factor in Eq. 9 is
        1 + hL. To put L = ‖J‖₂ counts it twice, and is not even an upper bound: the inequality
        |Φ(z̄) − Φ(z)| ≤ (1 + h‖J‖₂) |z̄ − z| for z̄ near z needs ‖J‖₂ ≤ 1 + h‖J‖₂. Now J = 1 + hf'
        + O(h²), so ‖J‖₂ = 1 + hs + O(h²) with s the greatest eigenvalue of the symmetric part of
        f', s² = `H_pq²` + (`H_pp` − `H_qq`)²/4, whereas 1 + h‖J‖₂ = 1 + h + O(h²). Wherever s > 1
        the inequality fails for all small h: for the Duffing oscillator s = 3|δ|q²/2, so it fails
        where |δ|q² > 2/3. (For the pendulum s = (1 − cos q)/2 ≤ 1.) What Eq. 9 needs in a norm is L
        = max (‖J‖₂ − 1)/h, or any bound of ‖ψ'‖, Φ = z + hψ, which stays bounded as h → 0; with it
        the conclusion of Section 2.2 stands. ∎""",
        [check],
    )


THEOREMS = {"eq-9": eq_9, "two-norm": two_norm}
