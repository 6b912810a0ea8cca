"""Smooth consistency: with it criteria 2–4 hold for every scheme, and without it they need not.

A one-step map Φ is smoothly consistent of order m ≥ 1 with the exact flow φ_h of Eq. 1 where

    Φ(z, h) = φ_h(z) + h^(m+1) ρ(z, h)

with a ρ that has first derivatives in z, both continuous up to h = 0. Every lieη, every
Runge–Kutta scheme and every splitting of a smooth H is. Consistency alone asks only that the local
error |Φ − φ_h| be O(h^(m+1)); then nothing is known of its derivatives, of which ΔJ is made.
"""

from collections.abc import Sequence
from fractions import Fraction

import flint
import sympy

from verify.arithmetic.exact import text
from verify.arithmetic.flint_precision import working_precision
from verify.claims.theorems.argument import Argument, Check, concluded, vanishes
from verify.claims.theorems.differential import Differential, Poly, flow_of_every_hamiltonian
from verify.claims.theorems.exact_maps import Point, areas, map_from_formulas
from verify.claims.theorems.oscillator import PRECISION
from verify.hamiltonians import systems
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.step_map import H_STEP, P, StepMap
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


def of_smooth_schemes(hamiltonian: bool = True) -> Argument:
    """Criteria 2, 3 and 4 hold for explicit Euler too, which blows every area up."""
    powers = consistent_map(hamiltonian)
    zero = flow_of_every_hamiltonian(1).ring.zero
    over_time = [_over_time(h) for h in STEP_SIZES]
    checks = [
        vanishes(
            "the coefficients of h⁰ and h¹ in ΔJ of a generic smoothly consistent map of a "
            "generic H",
            *(powers.get(n, zero) for n in (0, 1)),
        ),
        _euler(),
        *over_time,
    ]
    grown = enclosed_growth(STEP_SIZES[0])[1]
    return concluded(
        "criteria-of-consistent-schemes",
        Verdict.PROVED,
        "every smoothly consistent scheme has ΔJ = O(h²), hence MSE = O(h⁴) and Λ = O(h) on every "
        "[0, T]: all satisfy all three, explicit Euler too, whose Λ for the oscillator at h = "
        f"{text(STEP_SIZES[0])}, T = {TIME} is {grown}",
        f"""A step Φ is smoothly consistent with Eq. 1 where Φ(z) = φ(z) + `h^(m+1)` ρ(z, h), m ≥ 1,
        φ the exact flow over h, with a ρ whose values and first derivatives in z are continuous up
        to h = 0. Since det φ' = 1 (Liouville), det Φ' = 1 + O(`h^(m+1)`) uniformly on compact sets.
        On every [0, T] on which the exact solution exists the run stays in a compact set for small
        h, so `ΔJ_k` = O(h²) = o(h), MSE = O(h⁴) = o(h) and |Λ| ≤ exp(T O(h)) − 1 → 0: criteria 2, 3
        and 4 hold for every smoothly consistent scheme, whatever it does to areas otherwise, and
        say no more than that. (They are asymptotic in h, and for a given h they say nothing.) The
        explicit Euler scheme, lie1, for H = (p² + q²)/2 has ΔJ = h² at every point, so 1 + Λ = `(1
        + h²)^(T/h)`, and for h = {text(STEP_SIZES[0])} and T = {TIME} the Λ of every region is
        {grown}; yet Λ → 0 as h → 0, and criteria 2 to 4 are satisfied. What tells schemes apart is
        the order r of ΔJ = O(`h^r`), the growth of Λ with T, and criterion 1. That ρ is smooth is
        needed: see the counterexample of order 1 for H = q. ∎""",
        checks,
    )


def _euler() -> Check:
    one = systems.get("harmonic").hamiltonian().with_values({"omega": 1})
    delta_j = lie_map(one, 1).delta_j
    return Check("ΔJ of lie1 for H = (p² + q²)/2 is h²", str(delta_j) == "h**2", f"`{delta_j}`")


def enclosed_growth(h: Fraction) -> tuple[bool, str]:
    """Whether 1 + Λ ≤ e^(Th) for lie1 on the oscillator over [0, TIME], and Λ, both enclosed."""
    with working_precision(PRECISION):
        size = flint.arb(flint.fmpq(h.numerator, h.denominator))
        log = (1 + size * size).log() * TIME / size
        lam = log.exp() - 1
        # 1 + Λ = exp(T log(1 + h²)/h) ≤ exp(T h), which is what tends to 1.
        return bool(log <= TIME * size), f"`{lam.str(6, radius=False)}`"


def _over_time(h: Fraction) -> Check:
    holds, lam = enclosed_growth(h)
    what = f"lie1, oscillator, h = {text(h)}, T = {TIME}: Λ, and 1 + Λ ≤ `e^(Th)`"
    return Check(what, holds, f"Λ = {lam}")


# -- without it ------------------------------------------------------------------------------------

RIPPLE = "p - h + h**{n}*sin(2*pi*p/h**{m})/(2*pi)"
ORDERS = (1, 2, 3)
STEPS = (4, 16)


def alone(ripple: str = RIPPLE) -> Argument:
    """A consistent scheme of any order that fails criteria 2 and 4; `ripple` is its p'."""
    checks = [check for m in ORDERS for check in _rippled(ripple.format(n=m + 1, m=m), m)]
    limit, growth = _tends_to_e(STEPS)
    return concluded(
        "consistency-is-not-enough",
        Verdict.PROVED,
        "for H = q the scheme p' = p − h + h² sin(2πp/h)/(2π), q' = q is of order 1, and along its "
        "run from (0, 0) every `ΔJ_k` is h, so that Λ = `(1 + h)^N` − 1 → e − 1 on [0, 1]",
        """Let H = q, whose exact flow is p ↦ p − h, q ↦ q, and Φ the map p' = p − h + `h^(m+1)`
        sin(2πp/`h^m`)/(2π), q' = q. Its local error is `h^(m+1)` sin(2πp/`h^m`)/(2π), at most
        `h^(m+1)`/(2π) everywhere, and p' = p + hψ(p) with ψ' = cos(2πp/`h^m`), which is at most 1
        in size: by the standard argument the scheme converges with order m. From (p, q) = (0, 0)
        with h = 1/N the run is `p_k` = −kh exactly, for there 2πp/`h^m` = −2πk `N^(m−1)` and the
        sine is 0; the cosine is 1, so `ΔJ_k` = h cos(2πp/`h^m`) = h for every k. Hence |`ΔJ_k`| is
        no higher-order infinitesimal of h, criterion 2 fails, MSE = h² is, so that criterion 3
        holds, and Λ = `(1 + h)^N` − 1 ≥ 1, which tends to e − 1: criterion 4 fails. The local error
        is `h^(m+1)` ρ with ρ = sin(2πp/`h^m`)/(2π), whose derivative in p is not bounded as h → 0:
        the scheme is consistent, and not smoothly so. ∎""",
        [*checks, Check("Λ tends to e − 1 on [0, 1]", limit, growth)],
    )


def _rippled(formula: str, m: int) -> list[Check]:
    """Order m by its local error, and ΔJ_k = h along the run, for all k and exactly for some N."""
    step = map_from_formulas(formula, "q")
    k = sympy.Symbol("k", integer=True)
    ripple = sympy.simplify((step.p_next - P + H_STEP) / H_STEP ** (m + 1))
    slope = sympy.simplify(sympy.diff(step.p_next - P, P) / H_STEP)
    along = {P: -k * H_STEP}
    whole = {H_STEP: 1 / sympy.Symbol("N", integer=True, positive=True)}
    moved = sympy.simplify((step.p_next - P + H_STEP).subs(along).subs(whole))
    area = sympy.simplify((step.delta_j / H_STEP).subs(along).subs(whole))
    runs = [_run_of(step, n) for n in STEPS]
    return [
        Check(
            f"H = q, p' = `{formula}`: the local error over `h^{m + 1}` is a sine over 2π, and "
            "ψ' is a cosine",
            (2 * sympy.pi * ripple).func is sympy.sin and slope.func is sympy.cos,
            f"`{ripple}`, `{slope}`",
        ),
        Check(
            "the same at p = −kh, h = 1/N, for all integers k and N: p' − p + h = 0, ΔJ = h",
            moved == 0 and area == 1,
            f"{moved}, ΔJ/h = {area}",
        ),
        Check(
            f"the same, run from (0, 0) to T = 1 with N = {', '.join(map(str, STEPS))}: all "
            "`ΔJ_k` = h, so that Λ = `(1 + h)^N` − 1 ≥ 1",
            all(runs),
            "exactly",
        ),
    ]


def _run_of(step: StepMap, steps: int) -> bool:
    """Exactly; a run whose numbers are not rational is none with ΔJ = h."""
    h = Fraction(1, steps)
    try:
        found = areas(step, Point(Fraction(0), Fraction(0)), h, steps)
    except ValueError:
        return False
    return set(found.delta_j) == {h} and found.lam == (1 + h) ** steps - 1 >= 1


def _tends_to_e(steps: Sequence[int]) -> tuple[bool, str]:
    """Whether e − (1 + 1/N)^N lies between 0 and e/(2N + 1), and Λ."""
    with working_precision(PRECISION):
        e, found = flint.arb(1).exp(), []
        for n in steps:
            power = flint.arb(flint.fmpq(n + 1, n)) ** n
            found.append((bool(e / (2 * n + 1) > e - power > 0), (power - 1)))
        shown = ", ".join(f"`{x.str(6, radius=False)}`" for _, x in found)
    listed = ", ".join(map(str, steps))
    return all(near for near, _ in found), f"for N = {listed} it is {shown}, e − 1 to 1/N"


THEOREMS = {
    "criteria-of-consistent-schemes": of_smooth_schemes,
    "consistency-is-not-enough": alone,
}
