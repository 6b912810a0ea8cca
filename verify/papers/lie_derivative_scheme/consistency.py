"""Smooth consistency, which implies criteria 2–4 for every scheme, and without which they may fail.

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

from verify.algebra.symbols import H_STEP, P
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.exact import text
from verify.papers.argument import BALLS, NUMBERS, Argument, ArgumentTexts, Check, vanishes
from verify.papers.differential_polynomials import Differential, Poly, flow_of_every_hamiltonian
from verify.papers.exact_maps import RationalPoint, areas, map_from_texts
from verify.papers.lie_derivative_scheme.examples import enclosures, oscillator
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

TIME = 20000
STEP_SIZES = (Fraction(1, 100), Fraction(1, 1000), Fraction(1, 10**6), Fraction(1, 10**9))


def consistent_map(hamiltonian: bool = True) -> dict[int, Poly]:
    """Return ΔJ, by powers of h, of p' = p + ha + h²r, q' = q + hb + h²s, for generic r and s.

    (a, b) is the vector field of a generic H; where `hamiltonian` is False, a generic one.
    """
    parts = [f"{name}_{z}" for name in "abrs" for z in "pq"]
    # Only first derivatives of the map enter ΔJ, so that the values of a, b, r, s are not needed.
    mixed = ["H1_1", "H2_0", "H0_2"]
    ring = Differential(["h", *parts, *mixed])
    h = ring["h"]
    a_p, a_q, b_p, b_q, r_p, r_q, s_p, s_q = (ring[name] for name in parts)
    if hamiltonian:
        # (a, b) = (−H_q, H_p) has trace 0, and the coefficient of h in ΔJ is that trace.
        a_p, a_q = -ring["H1_1"], -ring["H0_2"]
        b_p, b_q = ring["H2_0"], ring["H1_1"]
    u_p, u_q = h * a_p + h * h * r_p, h * a_q + h * h * r_q
    v_p, v_q = h * b_p + h * h * s_p, h * b_q + h * h * s_q
    return ring.powers(u_p + v_q + u_p * v_q - u_q * v_p, "h")


def small_determinant(hamiltonian: bool = True) -> Check:
    """Check that ΔJ = O(h²) for every smoothly consistent map of a generic H."""
    powers, zero = consistent_map(hamiltonian), flow_of_every_hamiltonian(1).ring.zero
    return vanishes(
        "the coefficients of h⁰ and h¹ in ΔJ of a generic smoothly consistent map of a generic H",
        *(powers.get(n, zero) for n in (0, 1)),
    )


def criteria_of_consistent_schemes(hamiltonian: bool = True) -> Argument:
    """Prove criteria 2, 3 and 4 also for explicit Euler, which blows every area up."""
    growth = enclosed_growth(STEP_SIZES[0])[1]
    return _TEXTS.proof(
        "criteria_of_consistent_schemes",
        small_determinant=small_determinant(hamiltonian),
        euler=_euler(),
        over_time=_over_time(STEP_SIZES[0]),
        other_step_sizes=[_over_time(h) for h in STEP_SIZES[1:]],
        step_size=text(STEP_SIZES[0]),
        time=str(TIME),
        growth=str(growth),
    )


def _euler() -> Check:
    delta_j = lie_map(oscillator(), 1).delta_j
    return Check("ΔJ of lie1 for H = (p² + q²)/2 is h²", str(delta_j) == "h**2", f"`{delta_j}`")


def enclosed_growth(h: Fraction) -> tuple[bool, str]:
    """Enclose Λ of lie1 on the oscillator over [0, TIME]; return True if 1 + Λ ≤ e^(Th), and Λ."""
    with enclosures():
        size = rational_ball(h)
        # In logarithms, as (1 + h²)^(T/h) has T/h up to 2·10¹³ factors.
        log = (1 + size * size).log() * TIME / size
        lam = log.exp() - 1
        # 1 + Λ = exp(T log(1 + h²)/h) ≤ exp(T h), which is what tends to 1.
        return bool(log <= TIME * size), f"`{lam.str(6, radius=False)}`"


def _over_time(h: Fraction) -> Check:
    holds, lam = enclosed_growth(h)
    statement = f"lie1, oscillator, h = {text(h)}, T = {TIME}: Λ, and 1 + Λ ≤ `e^(Th)`"
    return Check(statement, holds, f"Λ = {lam}", BALLS)


# -- without it ------------------------------------------------------------------------------------

RIPPLE = "p - h + h**{n}*sin(2*pi*p/h**{m})/(2*pi)"
ORDERS = (1, 2, 3)
STEPS = (4, 16)


def consistency_is_not_enough(ripple: str = RIPPLE) -> Argument:
    """Prove that a consistent scheme of any order may fail criteria 2 and 4; `ripple` is its p'."""
    checks = [_check_ripple(ripple.format(n=m + 1, m=m), m) for m in ORDERS]
    local, whole, run = zip(*checks, strict=True)
    limit, growth = _tends_to_e(STEPS)
    return _TEXTS.proof(
        "consistency_is_not_enough",
        local=local,
        whole=whole,
        run=run,
        tends_to_e=Check("Λ tends to e − 1 on [0, 1]", limit, growth, BALLS),
    )


def _check_ripple(formula: str, m: int) -> tuple[Check, Check, Check]:
    """Check order m by the local error, and ΔJ_k = h along the run, for all k and for some N."""
    step_map = map_from_texts(formula, "q")
    k = sympy.Symbol("k", integer=True)
    # ρ is the local error over h^(m+1). Its derivative grows like h^(−m): ρ is not smooth at h = 0.
    ripple = sympy.simplify((step_map.p_next - P + H_STEP) / H_STEP ** (m + 1))
    slope = sympy.simplify(sympy.diff(step_map.p_next - P, P) / H_STEP)
    steep = sympy.simplify(sympy.diff(ripple, P) * H_STEP**m - slope)
    # At p = −kh with h = 1/N the argument is an integer multiple of 2π for all integers k and N.
    on_run = {P: -k * H_STEP}
    whole = {H_STEP: 1 / sympy.Symbol("N", integer=True, positive=True)}
    image = sympy.simplify((step_map.p_next - P + H_STEP).subs(on_run).subs(whole))
    area = sympy.simplify((step_map.delta_j / H_STEP).subs(on_run).subs(whole))
    runs = [_run_is_as_stated(step_map, n) for n in STEPS]
    return (
        Check(
            f"H = q, p' = `{formula}`: the local error over `h^{m + 1}` is a sine over 2π, ψ' is a "
            f"cosine, and `h^{m}` ∂ρ/∂p that cosine",
            (2 * sympy.pi * ripple).func is sympy.sin and slope.func is sympy.cos and steep == 0,
            f"`{ripple}`, `{slope}`",
        ),
        Check(
            f"m = {m}, at p = −kh, h = 1/N, for all integers k and N: p' − p + h = 0, ΔJ = h",
            image == 0 and area == 1,
            f"{image}, ΔJ/h = {area}",
        ),
        Check(
            f"m = {m}, run from (0, 0) to T = 1 with N = {', '.join(map(str, STEPS))}: all "
            "`ΔJ_k` = h, so that Λ = `(1 + h)^N` − 1 ≥ 1",
            all(runs),
            "exactly",
            NUMBERS,
        ),
    )


def _run_is_as_stated(step_map: StepMap, steps: int) -> bool:
    """Return True if all ΔJ_k are h exactly; False also for a run that is not rational."""
    h = Fraction(1, steps)
    try:
        run = areas(step_map, RationalPoint(Fraction(0), Fraction(0)), h, steps)
    except ValueError:
        return False
    return set(run.delta_j) == {h} and run.lam == (1 + h) ** steps - 1 >= 1


def _tends_to_e(steps: Sequence[int]) -> tuple[bool, str]:
    """Return True if 0 < e − (1 + 1/N)^N < e/(2N + 1) for each N, and a text with Λ."""
    with enclosures():
        e, comparisons = flint.arb(1).exp(), []
        for n in steps:
            # e − (1 + 1/N)^N < e/(2N + 1), a classical bound, shows the limit without taking one.
            power = rational_ball(Fraction(n + 1, n)) ** n
            comparisons.append((bool(e / (2 * n + 1) > e - power > 0), (power - 1)))
        values = ", ".join(f"`{x.str(6, radius=False)}`" for _, x in comparisons)
    counts = ", ".join(map(str, steps))
    return all(near for near, _ in comparisons), f"for N = {counts} it is {values}, e − 1 to 1/N"
