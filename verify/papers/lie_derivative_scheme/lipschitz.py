"""Eq. 9, the Lipschitz condition by components: it does not hold as printed."""

from collections.abc import Sequence
from fractions import Fraction

import flint
import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.exact import decimal, text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import BALLS, NUMBERS, Argument, ArgumentTexts, Check, same, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.exact_maps import RationalPoint, jacobian, next_point, squared_distance
from verify.papers.lie_derivative_scheme.examples import duffing_step, enclosures, errors, factor

_TEXTS = ArgumentTexts(__file__)

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
    return _TEXTS.refutation(
        "eq_9",
        differs=differs,
        for_every_h=for_every_h,
        first_terms=_first_terms(),
        decoupling=_decoupling(mixed),
        along_a_run=[along_a_run(size) for size in STEP_SIZES],
        first_q=text(pair[0].q),
        second_q=text(pair[1].q),
        left=text(left),
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
    return _TEXTS.proof("eq_9_plane", stretch=[_stretch(h, norm) for h in STEP_SIZES])


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
    return _TEXTS.refutation(
        "convergence_inference",
        along_a_run=[along_a_run(size) for size in STEP_SIZES],
        step_sizes=", ".join(map(text, STEP_SIZES)),
    )
