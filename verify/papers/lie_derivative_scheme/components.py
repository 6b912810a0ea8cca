"""Eq. 9, 10 and 11 as their letters and superscripts are printed: with p̃_k, and for p alone."""

from fractions import Fraction

import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.exact import decimal, text
from verify.execution.keeper import NOTHING
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import BALLS, Argument, ArgumentTexts, Check, Step, same
from verify.papers.exact_maps import run_symbolically
from verify.papers.lie_derivative_scheme.examples import enclosures, errors, factor
from verify.runs.task import RunTask
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

LEVELS = "-(q - p**3) + (q - p**3)**2/2"  # H is a function of u = q − p³, which it keeps
_STEPS = (10, 100, 1000)
_ETAS = range(1, 5)
_LEVEL = Q - P**3


# -- Eq. 9 -----------------------------------------------------------------------------------------


def eq_9_kept() -> Argument:
    """Refute Eq. 9 in a norm with z̃_k on its right, which is 0 at k = 1 where its left is not."""
    return _TEXTS.refutation("eq_9_kept", after_two=map(_after_two, _ETAS))


def _after_two(eta: int, h: Fraction = Fraction(1, 10)) -> Check:
    """Check that the left side of Eq. 9 at k = 1 is not 0, for the oscillator."""
    with enclosures():
        # R ≠ 0 multiplies every difference, and the local error is errors(…)[1].
        left_side = abs(factor(eta, h) * errors(eta, h, 1)[-1])
        size_text, is_positive = left_side.mid().str(4, radius=False), bool(left_side > 0)
    return Check(
        f"oscillator from (q, p) = (1, 0), lie{eta}, h = {text(h)}: |`z̃_2` − `z_2`| > 0",
        is_positive,
        f"`{size_text}`",
        BALLS,
    )


# -- Eq. 10 and 11 ---------------------------------------------------------------------------------


def eq_10_components(formula: str = LEVELS) -> Argument:
    """Refute Eq. 10 for p alone, e_k for e_n: at k = 1 its right side is 0, its left is not."""
    return _TEXTS.refutation(
        "eq_10_components", steps_for=_steps_for(formula), second_step=_second_step(formula)
    )


def eq_11(formula: str = LEVELS) -> Argument:
    """Refute Eq. 11 for p alone: its right side is 0, and e^p is about h²/2 at t = 1."""
    return _TEXTS.refutation(
        "eq_11",
        steps_for=_steps_for(formula),
        check_sum=_check_sum(),
        check_at_1=[_check_at_1(formula, n) for n in _STEPS],
    )


def _steps_for(formula: str) -> list[Step]:
    """Show that a step of lie2 adds hv to p, without a local error, and h³v³ to v."""
    hamiltonian = Hamiltonian.parse(formula)
    scheme, v = lie_map(hamiltonian, 2), 1 - _LEVEL
    h_p, h_q = (sympy.diff(hamiltonian.expression, z) for z in (P, Q))
    # v is a first integral, so that X v = 0, Xp = v and Xⁿp = 0 for n ≥ 2.
    field = same(
        f"H = `{formula}`: `H_q` + v, `H_p` − 3p²v and X v, v = 1 − q + p³",
        [h_q + v, h_p - 3 * P**2 * v, h_p * sympy.diff(v, Q) - h_q * sympy.diff(v, P)],
        ("p", "q"),
    )
    v_next = v.subs({P: scheme.p_next, Q: scheme.q_next}, simultaneous=True)
    after_step = same(
        f"H = `{formula}`, lie2: p' − p − hv, and v' − v − h³v³",
        [scheme.p_next - P - H_STEP * v, sympy.expand(v_next - v - H_STEP**3 * v**3)],
        ("p", "q", "h"),
    )
    return _TEXTS.steps("_steps_for", field=field, after_step=after_step)


def _second_step(formula: str) -> Check:
    p, _ = run_symbolically(lie_map(Hamiltonian.parse(formula), 2), (sympy.S.Zero, sympy.S.Zero), 2)
    gap = p - 2 * H_STEP - H_STEP**4
    return same("two steps of lie2 from (0, 0): `p_2` − 2h − h⁴", [gap], ("h",))


def _check_sum() -> Check:
    n, k = sympy.symbols("n k", integer=True, positive=True)
    # Induction on k: v_0 = 1, and v' ≥ v + h³ as long as v ≥ 1.
    gap = sympy.expand(sympy.summation(k, (k, 0, n - 1)) - n * (n - 1) / 2)
    return Check("Σ k, k = 0 … N − 1, less N(N − 1)/2", gap == 0, f"`{gap}`")


def _check_at_1(formula: str, steps: int) -> Check:
    """Check e^p at t = 1 by a run of this toolkit with certified digits."""
    h = Fraction(1, steps)
    run = RunTask(
        hamiltonian=formula, parameters={}, scheme="lie2", p=Fraction(0), q=Fraction(0),
        step_size=h, steps=steps, arithmetic="auto", digits=20, observables=(), points=0,
    ).compute(NOTHING)  # fmt: skip
    value = run.values["p"]
    # The upper bound h² is a control: a run that went astray would exceed it.
    low = abs(Fraction(value.value) - 1) - Fraction(value.bound)
    return Check(
        f"H = `{formula}`, lie2, h = {text(h)}, from (0, 0), N = {steps}: |p − 1| ≥ h²(1 − h)/2, "
        "and at most h², by a run with a rigorous bound",
        run.error_kind == "enclosed" and h * h * (1 - h) / 2 <= low <= h * h,
        f"`{decimal(low, 4)}` ≥ `{decimal(h * h * (1 - h) / 2, 4)}`",
        BALLS,
    )
