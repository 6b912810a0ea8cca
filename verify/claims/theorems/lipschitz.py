"""Eq. 9, the Lipschitz condition by components, and L_p = ‖J_k‖₂: neither holds as printed."""

from collections.abc import Sequence
from fractions import Fraction

import flint

from verify.arithmetic.exact import decimal, text
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


def of_the_plane(norm: float = 1.0) -> Argument:
    """Eq. 9 for both components in one norm; `norm` scales L, to see that the check notices."""
    checks = [_stretch(h, norm) for h in STEP_SIZES]
    return concluded(
        "eq-9-plane",
        Verdict.PROVED,
        "|Φ(z̄) − Φ(z)| ≤ (1 + hL) |z̄ − z| for both components together, with L the greatest "
        "norm of ψ', Φ = z + hψ, on a convex compact set around the solution: one L for all 0 < h "
        "≤ h₀",
        """Let H be of class `C^(η+1)` near the solution and K a convex compact set in which that
        holds. Φ(z) = z + hψ(z, h) with ψ = Σ `h^(n−1)`/n! Xⁿz, n = 1 … η, of class C¹ in z,
        continuous in h up to 0. Let L be the maximum of ‖ψ'‖ over K and 0 ≤ h ≤ h₀. By the mean
        value theorem along the segment from z to z̄, |Φ(z̄) − Φ(z)| ≤ (1 + hL) |z̄ − z|. (For η =
        1, “the first-order truncated”, ψ = f, and L is the greatest norm of f'.) ∎""",
        checks,
    )


def _stretch(h: Fraction, norm: float) -> Check:
    """Duffing, δ = 1, lie2 on the square |p|, |q| ≤ 1, where every entry of ψ' is largest in size
    at a corner: ‖ψ'‖² is at most the sum of their squares."""
    step, bound = lie_map(_duffing(), 2), Fraction(norm) * 5
    corners = [Point(Fraction(a), Fraction(b)) for a in (-1, 1) for b in (-1, 1)]
    images = [next_point(step, z, h) for z in corners]
    pairs = [(i, j) for i in range(len(corners)) for j in range(i)]
    worst = max(_squared(images[i], images[j]) / _squared(corners[i], corners[j]) for i, j in pairs)
    slopes = [zip(jacobian(step, z, h), (1, 0, 0, 1), strict=True) for z in corners]
    squares = max(sum((((x - unit) / h) ** 2 for x, unit in each), Fraction(0)) for each in slopes)
    return Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, on |p|, |q| ≤ 1: ‖(J − 1)/h‖² ≤ L² with L = "
        f"{text(bound)}, and |Φ(z̄) − Φ(z)|²/|z̄ − z|² ≤ (1 + hL)² for the pairs of its corners",
        squares <= bound**2 and worst <= (1 + h * bound) ** 2,
        f"`{decimal(squares, 4)}`, `{decimal(worst, 4)}`",
    )


def _squared(one: Point, other: Point) -> Fraction:
    return (one.p - other.p) ** 2 + (one.q - other.q) ** 2


def norm_of_the_step(scale: Fraction = Fraction(1)) -> Argument:
    """‖J‖₂ as the Lipschitz constant of the step itself, the 1 + hL of Eq. 9; `scale` times it.

    On the segment between two points |Φ(z̄) − Φ(z)|² ≤ max ‖J‖₂² |z̄ − z|².
    """
    h = Fraction(1, 10)
    step, ends = lie_map(_duffing(), 2), PAIR
    images = [next_point(step, z, h) for z in ends]
    moved = _squared(*images) / _squared(*ends)
    between = [Point(Fraction(0), Fraction(k, 8)) for k in range(9)]
    norms = [_norm_squared(jacobian(step, z, h)) for z in between]
    return concluded(
        "two-norm-of-the-step",
        Verdict.PROVED,
        "the greatest ‖`J_k`‖₂ on a convex set is the least Lipschitz constant there of "
        "(`p_{k+1}`, `q_{k+1}`) as functions of (`p_k`, `q_k`), which is the factor 1 + hL of Eq. "
        "9",
        """By the mean value theorem |Φ(z̄) − Φ(z)| ≤ max ‖J‖₂ |z̄ − z|, the maximum over the
        segment, and along the direction that J stretches most nothing less will do. So if `L_p`
        stands for the Lipschitz constant “of `p_{k+1}` and `q_{k+1}`”, as the text after Eq. 9
        calls it, then ‖`J_k`‖₂ is right. It then takes the place of the whole factor 1 + hL in Eq.
        9. ∎""",
        [
            Check(
                f"Duffing, δ = 1, lie2, h = {text(h)}: |Φ(z̄) − Φ(z)|²/|z̄ − z|² for (p, q) = "
                f"{ends[0]} and {ends[1]}, at most the greatest of 9 lower bounds of ‖J‖₂² between",
                moved <= scale * max(norms),
                f"`{decimal(moved, 4)}` ≤ `{decimal(scale * max(norms), 4)}`",
            )
        ],
    )


def _norm_squared(entries: tuple[Fraction, ...]) -> Fraction:
    """A lower bound of ‖J‖₂²: |J v|²/|v|² for the better of v = (0, 1) and (1, 0)."""
    a, b, c, d = entries
    return max(a * a + c * c, b * b + d * d)


def inference() -> Argument:
    """“Therefore convergent”, by Eq. 9–11 as they are printed."""
    checks = [_along_a_run(size) for size in STEP_SIZES]
    return concluded(
        "convergence-inference",
        Verdict.REFUTED,
        "the printed way leads through Eq. 9 with the p-difference alone on the right, for which "
        "no constant `L_p` will do along a run of the oscillator: an `L_p` above 1/h makes "
        "`e^(L_p T)` of Eq. 11 useless; with both components together the same steps prove it",
        """Eq. 11 is summed from Eq. 10, and that from Eq. 9. Eq. 9 with one component on its right
        side asks for an `L_p` ≥ (1 − O(h))/h along the run of lie2 for H = (p² + q²)/2 from (q, p)
        = (1, 0), see the claim on Eq. 9. With such an `L_p` the factor `(1 + hL_p)^k` of Eq. 11 is
        about `2^k`, and C̃ does not stay bounded as h → 0; so nothing follows of the error as h →
        0. The conclusion is true, by the same steps for both components in one norm. ∎""",
        checks,
    )


THEOREMS = {
    "eq-9": eq_9,
    "eq-9-plane": of_the_plane,
    "two-norm": two_norm,
    "two-norm-of-the-step": norm_of_the_step,
    "convergence-inference": inference,
}
