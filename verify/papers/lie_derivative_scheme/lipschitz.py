"""Eq. 9, the Lipschitz condition by components: it does not hold as printed."""

from collections.abc import Sequence
from fractions import Fraction

import flint
import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.exact import decimal, text
from verify.hamiltonians.hamiltonian import Hamiltonian
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
from verify.papers.exact_maps import RationalPoint, jacobian, next_point, squared_distance
from verify.papers.lie_derivative_scheme.examples import duffing_step, enclosures, errors, factor

PAIR = (RationalPoint(p=Fraction(0), q=Fraction(0)), RationalPoint(p=Fraction(0), q=Fraction(1)))
STEP_SIZES = (Fraction(1, 10), Fraction(1, 100), Fraction(1, 1000))
LATEST = 4  # runs are looked at up to this time
MIXED = "a*p*q + b*p + c*q"  # H_pp = H_qq = 0


def eq_9(pair: tuple[RationalPoint, RationalPoint] = PAIR, mixed: str = MIXED) -> Argument:
    """Refute Eq. 9 by a pair of points with equal p, and along a run of the oscillator.

    `mixed`: an H for which both components decouple.
    """
    h = Fraction(1, 10)
    step_map = duffing_step()
    # The p-difference of the two points is 0, so that no L_p makes the right side positive.
    ends = [next_point(step_map, point, h) for point in pair]
    left, right = abs(ends[1].p - ends[0].p), abs(pair[1].p - pair[0].p)
    differs = Check(
        f"Duffing, δ = 1, lie2, h = 0.1, from (p, q) = {pair[0]} and {pair[1]}: |p̃ − p| before "
        "and after the step",
        right == 0 and left > 0,
        f"{text(right)} and {text(left)}",
        NUMBERS,
    )
    images_of_p = [step_map.p_next.subs({P: z.p, Q: z.q}, simultaneous=True) for z in pair]
    for_every_h = same(
        f"the same for every h: p' from {pair[0]} less p' from {pair[1]}, less 2h",
        [images_of_p[0] - images_of_p[1] - 2 * H_STEP],
        ("h",),
    )
    return refutation(
        f"""
        for the Duffing oscillator (δ = 1, h = 0.1) two points with the same p, with q =
        {text(pair[0].q)} and q = {text(pair[1].q)}, have |p̃ − p| = {text(left)} after one step,
        where the right side is 0 for every `L_p`; for p alone and for q alone Eq. 9 holds, for all
        small h, only where `H_pp` = 0 and `H_qq` = 0

        The right side has the p-difference alone, while `p_{{k+1}}` depends on `q_k`, too.

        - Take two points with the same p and different q: the right side is 0 whatever `L_p` is.
          For the Duffing oscillator with δ = 1 and lie2, from (p, q) = (0, 0) and (0, 1), the left
          side is ``|p'(0, 0) − p'(0, 1)| = 2h``. [differs, for_every_h]
        - For a general H: if Eq. 9 holds for all pairs of points of a rectangle and for all small
          h, with whatever constants, then p' does not depend on q there, and q' not on p. The
          coefficients of h in p' and q' are −`H_q` and `H_p`. [first_terms]
        - So ``H_{{qq}} = 0, H_{{pp}} = 0``, and H = a pq + b p + c q + d.
        - For such an H both components decouple, for every η. [decoupling]
        - There Eq. 9 holds for h ≤ h₀ with ``L_p = L_q = (e^(|a|h_0) − 1)/h_0``.
        - It is no way out that `z̄_k` and `z_k` belong to an exact solution and to the run that
          starts on it. For the oscillator H = (p² + q²)/2 from (q, p) = (1, 0) the error of lie2 at
          time t is, in (q, p), ``(t h^2/6)(sin t, cos t) + O(h^3)``: it turns with the solution, by
          an angle h in a step.
        - In the step after its p-component has changed sign near t = π/2 that component grows by a
          factor of 2 − O(h) at least, so that `L_p` ≥ (1 − O(h))/h: no constant will do, neither
          with `p̄_k` on the right, which Eq. 8 and 10 need, nor with `p̃_k` as printed. [tried
          along_a_run]

        What holds is the inequality in a norm of the plane: |Φ(z̄) − Φ(z)| ≤ (1 + hL) |z̄ − z|, or
        by components |`p̃_{{k+1}}` − `p_{{k+1}}`| ≤ (1 + hL) |`p̄_k` − `p_k`| + hL |`q̄_k` −
        `q_k`|; with either, the conclusion of Section 2.2 stands.
        """,
        differs=differs,
        for_every_h=for_every_h,
        first_terms=_first_terms(),
        decoupling=_decoupling(mixed),
        along_a_run=[along_a_run(size) for size in STEP_SIZES],
    )


def _first_terms() -> Check:
    flow = flow_of_every_hamiltonian(3)
    p_next, q_next = (flow.ring.powers(x, "h")[1] for x in flow.lie(2))
    return vanishes(
        "the coefficients of h in p' and q' of lie2, plus `H_q` and less `H_p`, for a generic H",
        p_next + flow.h_q,
        q_next - flow.h_p,
    )


def _decoupling(mixed: str) -> Check:
    """Check that Xp is a function of p alone, and Xq of q, so that every Xⁿp and Xⁿq is."""
    hamiltonian = Hamiltonian.parse(mixed)
    h_p, h_q = (sympy.diff(hamiltonian.exact, z) for z in (P, Q))
    names = ("p", "q", *hamiltonian.parameters)
    gaps = [sympy.diff(h_q, Q), sympy.diff(h_p, P)]
    return same(f"H = `{mixed}`: ∂(X p)/∂q and ∂(X q)/∂p", gaps, names)


def along_a_run(h: Fraction) -> Check:
    """Check the greatest L_p that a step of the run requires, for both readings of Eq. 9."""
    steps = int(LATEST / h)
    with enclosures():
        # p is the imaginary part of q + ip; the next error in p comes from both parts.
        error, scheme = errors(2, h, steps), factor(2, h)
        size = 1 / float(h)
        by_exact_points = _largest(
            [(scheme * e).imag for e in error], [e.imag for e in error], size
        )
        images = [(scheme * e).imag for e in error]
        as_printed = _largest(images[1:], images[:-1], size)
    return Check(
        f"oscillator from (q, p) = (1, 0), lie2, h = {text(h)}, t ≤ {LATEST}: the `L_p` that a "
        "step of the run asks for, with `p̄_k` and with `p̃_k` on the right, is above 1/h",
        min(by_exact_points, as_printed) > size,
        f"`{by_exact_points:.3g}` and `{as_printed:.3g}`",
        BALLS,
    )


def _largest(left: Sequence[flint.arb], right: Sequence[flint.arb], scale: float) -> float:
    """Return a lower bound of max (left/right − 1)/h over the steps where right is not 0."""
    # Steps whose right side may be 0 are left out, so that the maximum stays a lower bound.
    norms = [
        float((abs(x) / abs(y)).lower())
        for x, y in zip(left, right, strict=True)
        if not y.contains(0)
    ]
    return (max(norms) - 1) * scale


def eq_9_plane(norm: float = 1.0) -> Argument:
    """Prove Eq. 9 for both components in one norm; `norm` scales L, as a control."""
    return proof(
        """
        repaired, with `z̄_k` for `z̃_k` and both components together, it holds: |Φ(`z̄_k`) −
        Φ(`z_k`)| ≤ (1 + hL) |`z̄_k` − `z_k`|, with L the greatest norm of ψ', Φ = z + hψ, on a
        convex compact set around the solution: one L for all 0 < h ≤ h₀

        Let H be of class `C^(η+1)` near the solution and K a convex compact set in which that
        holds.

        - Φ(z) = z + hψ(z, h) with ``ψ = Σ_{n=1}^{η} h^(n−1)/n! X^n z``, of class C¹ in z,
          continuous in h up to 0. So the norm of ψ' has a maximum L over K and 0 ≤ h ≤ h₀.
        - By the mean value theorem along the segment from z to z̄ ``|Φ(z̄) − Φ(z)| ≤ (1 + hL) |z̄ −
          z|``. [tried stretch]

        For η = 1, “the first-order truncated”, ψ = f, and L is the greatest norm of f'. Eq. 9
        prints `p̃_k` on the right; Eq. 8 and 10 need `p̄_k`, as here.
        """,
        stretch=[_stretch(h, norm) for h in STEP_SIZES],
    )


def _stretch(h: Fraction, norm: float) -> Check:
    """Check L for Duffing, δ = 1, lie2, on |q|, |p| ≤ 1.

    Every entry of ψ' is largest in size at a corner, and ‖ψ'‖² is at most the sum of their squares.
    """
    scheme, bound = duffing_step(), Fraction(norm) * 5
    corners = [RationalPoint(Fraction(a), Fraction(b)) for a in (-1, 1) for b in (-1, 1)]
    images = [next_point(scheme, z, h) for z in corners]
    pairs = [(i, j) for i in range(len(corners)) for j in range(i)]
    worst = max(
        squared_distance(images[i], images[j]) / squared_distance(corners[i], corners[j])
        for i, j in pairs
    )
    slopes = [zip(jacobian(scheme, z, h), (1, 0, 0, 1), strict=True) for z in corners]
    # Frobenius' norm bounds the 2-norm from above, and is a polynomial in the entries.
    squares = max(
        sum((((x - unit) / h) ** 2 for x, unit in entries), Fraction(0)) for entries in slopes
    )
    return Check(
        f"Duffing, δ = 1, lie2, h = {text(h)}, on |p|, |q| ≤ 1: ‖(J − 1)/h‖² ≤ L² with L = "
        f"{text(bound)}, and |Φ(z̄) − Φ(z)|²/|z̄ − z|² ≤ (1 + hL)² for the pairs of its corners",
        squares <= bound**2 and worst <= (1 + h * bound) ** 2,
        f"`{decimal(squares, 4)}`, `{decimal(worst, 4)}`",
        NUMBERS,
    )


def convergence_inference() -> Argument:
    """Refute that convergence follows from Eq. 9–11 as they are printed."""
    return refutation(
        f"""
        the printed argument goes through Eq. 9 with the p-difference alone on the right, for which
        no constant `L_p` will do along a run of the oscillator: it takes an `L_p` above 1/h, with
        which the bound of Eq. 11 does not tend to 0; with both components together the same steps
        prove it

        Eq. 11 is summed from Eq. 10, and that from Eq. 9.

        - Eq. 9 with one component on its right side asks for an `L_p` above 1/h along the run of
          lie2 for H = (p² + q²)/2 from (q, p) = (1, 0), for h = {", ".join(map(text, STEP_SIZES))}.
          [along_a_run]
        - So it is for every small h, and the factor of Eq. 11 is ``(1 + hL_p)^k > 2^k``: C̃ does
          not stay bounded as h → 0, and nothing follows of the error. (See the claim on Eq. 9.)

        The conclusion is true, by the same steps for both components in one norm.
        """,
        along_a_run=[along_a_run(size) for size in STEP_SIZES],
    )
