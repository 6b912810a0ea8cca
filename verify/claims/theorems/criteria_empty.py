"""Criteria 2–4 hold for every consistent scheme, and tell none from another; Λ need not grow."""

from fractions import Fraction
from itertools import pairwise

import flint

from verify.arithmetic.exact import decimal, text
from verify.arithmetic.flint_precision import working_precision
from verify.claims.theorems.argument import Argument, Check, concluded, vanishes
from verify.claims.theorems.differential import Differential, Poly, flow_of_every_hamiltonian
from verify.claims.theorems.exact_maps import Areas, Point, areas
from verify.claims.theorems.oscillator import PRECISION
from verify.hamiltonians import systems
from verify.proof.telescoping import potential_of_lie
from verify.schemes.methods.taylor.lie import lie_map
from verify.verdict import Verdict

TIME = 20000
STEP_SIZES = (Fraction(1, 100), Fraction(1, 1000), Fraction(1, 10**6), Fraction(1, 10**9))


def consistent_map(hamiltonian: bool = True) -> dict[int, Poly]:
    """ΔJ, by powers of h, of p' = p + ha + h²r, q' = q + hb + h²s, for generic r and s.

    (a, b) is the vector field of a generic H; where `hamiltonian` is False, a generic one.
    """
    parts = [f"{name}_{z}" for name in "abrs" for z in "pq"]
    mixed = ["H1_1", "H2_0", "H0_2"]
    ring = Differential(["h", *parts, *mixed])
    h = ring["h"]
    a_p, a_q, b_p, b_q, r_p, r_q, s_p, s_q = (ring[name] for name in parts)
    if hamiltonian:
        a_p, a_q = -ring["H1_1"], -ring["H0_2"]
        b_p, b_q = ring["H2_0"], ring["H1_1"]
    u_p, u_q = h * a_p + h * h * r_p, h * a_q + h * h * r_q
    v_p, v_q = h * b_p + h * h * s_p, h * b_q + h * h * s_q
    return ring.powers(u_p + v_q + u_p * v_q - u_q * v_p, "h")


def empty(hamiltonian: bool = True) -> Argument:
    """Explicit Euler satisfies criteria 2, 3 and 4, and blows every area up."""
    powers = consistent_map(hamiltonian)
    zero = flow_of_every_hamiltonian(1).ring.zero
    checks = [
        vanishes(
            "the coefficients of h⁰ and h¹ in ΔJ of a generic consistent map of a generic H",
            *(powers.get(n, zero) for n in (0, 1)),
        ),
        _euler(),
        *(_over_time(h) for h in STEP_SIZES),
    ]
    return concluded(
        "criteria-of-consistent-schemes",
        Verdict.REFUTED,
        "every consistent scheme has ΔJ = O(h²), hence MSE = O(h⁴) and Λ = O(h) on every [0, T]: "
        "all "
        "satisfy all three, explicit Euler too, whose Λ for the oscillator at the paper's h = "
        "0.01, "
        f"T = {TIME} is 7.15·10⁸⁶",
        """Let a step agree with the exact flow φ of Eq. 1 up to h¹: Φ(z) = φ(z) + h²ρ(z, h), where
        ρ has continuous first derivatives in z up to h = 0. Since det φ' = 1 (Liouville), det Φ' =
        1 + O(h²) uniformly on compact sets. On every [0, T] on which the exact solution exists the
        run stays in a compact set for small h, so `ΔJ_k` = O(h²) = o(h), MSE = O(h⁴) = o(h) and |Λ|
        ≤ exp(T O(h)) − 1 → 0: criteria 2, 3 and 4 hold for every consistent scheme, whatever it
        does to areas otherwise, and say no more than consistency does. (They are asymptotic in h,
        and for a given h they say nothing.) The explicit Euler scheme, lie1, for H = (p² + q²)/2
        has ΔJ = h² at every point, so 1 + Λ = `(1 + h²)^(T/h)`, and for h = 0.01 and T = 20000
        every area has grown by a factor of 7.15·10⁸⁶; yet Λ → 0 as h → 0, and criteria 2 to 4 are
        satisfied. What tells schemes apart is the order r of ΔJ = O(`h^r`), the growth of Λ with T,
        and criterion 1. ∎""",
        checks,
    )


def _euler() -> Check:
    one = systems.get("harmonic").hamiltonian().with_values({"omega": 1})
    delta_j = lie_map(one, 1).delta_j
    return Check("ΔJ of lie1 for H = (p² + q²)/2 is h²", str(delta_j) == "h**2", f"`{delta_j}`")


def _over_time(h: Fraction) -> Check:
    """lg (1 + Λ) of lie1 over [0, TIME], enclosed."""
    with working_precision(PRECISION):
        size = flint.arb(flint.fmpq(h.numerator, h.denominator))
        log = (1 + size * size).log() * TIME / size
        lam = log.exp() - 1
        # 1 + Λ = exp(T log(1 + h²)/h) ≤ exp(T h), which is what tends to 1.
        holds = bool(log <= TIME * size)
        shown = lam.mid().str(6, radius=False)
    return Check(
        f"lie1, oscillator, h = {text(h)}, T = {TIME}: Λ, and 1 + Λ ≤ `e^(Th)`",
        holds,
        f"Λ = `{shown}`",
    )


START = Point(p=Fraction(1), q=Fraction(-1, 20))


def increasing(start: Point = START, h: Fraction = Fraction(1, 10), steps: int = 3) -> Argument:
    """|Λ| after n steps falls: exact for the Duffing oscillator, and why for every even η."""
    duffing = systems.get("duffing").hamiltonian().with_values({"delta": 1})
    found = areas(lie_map(duffing, 2), start, h, steps).delta_j
    totals = [abs(Areas(found[:n]).lam) for n in range(1, steps + 1)]
    shown = ", ".join(f"`{decimal(x, 4)}`" for x in totals)
    flow = flow_of_every_hamiltonian(4)
    leading = flow.delta_j(*flow.lie(2))[3]
    checks = [
        Check(
            f"Duffing, δ = 1, lie2, h = {text(h)}, from (p, q) = {start}: |Λ| after n steps falls, "
            f"n = 1 … {steps}",
            any(later < earlier for earlier, later in pairwise(totals)),
            shown,
        ),
        vanishes(
            "the coefficient of h³ in ΔJ of lie2 is X·G for a generic H, with G = det Hess H/2",
            leading - flow.derive(potential_of_lie(flow, 2)),
            potential_of_lie(flow, 2) - flow.hessian_determinant / 2,
        ),
    ]
    return concluded(
        "total-error-increases",
        Verdict.REFUTED,
        f"for the Duffing oscillator (δ = 1, lie2, h = {text(h)}) from (p, q) = {start}, |Λ| after "
        f"1, 2, … steps is {shown}, exact but for the "
        "rounding of what is shown; the "
        "leading "
        "part of Λ is a boundary term that does not grow",
        """`ΔJ_k` has both signs, so its product need not grow: from (p, q) = (1, −1/20) the Duffing
        oscillator crosses q = 0, where pq changes its sign and with it 3h³δpq, and |Λ| falls within
        two steps. It is not a matter of a few steps. For lie2 and every smooth H the leading term
        of ΔJ is (h³/2) X(det Hess H), a derivative along the flow. On a fixed [0, T] its sum is
        therefore a boundary term, Λ = (h²/2) [det Hess H](z(T)) − (h²/2) [det Hess H](z(0)) +
        O(h³), which on a periodic orbit returns to O(h³) after every period. It is the next order
        that may grow with T. ∎""",
        checks,
    )


THEOREMS = {
    "criteria-of-consistent-schemes": empty,
    "total-error-increases": increasing,
}
