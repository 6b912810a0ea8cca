"""Eq. 8–11: the scheme converges with order η, by a joint Lipschitz constant; Eq. 10 as printed."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.arb import rational_ball
from verify.papers.argument import BALLS, Argument, ArgumentTexts, Check, same
from verify.papers.elementary_identities import geometric
from verify.papers.lie_derivative_scheme import examples
from verify.proof.order_for_one_h import convergence_of
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

ETAS = range(1, 5)
STEPS = (10, 100, 1000)
_LIPSCHITZ = 1  # of lie1 for the oscillator: ψ = f, and the norm of f' is 1


def convergence(shift: int = 0) -> Argument:
    """Prove that the global error is O(h^η); `shift` is added to the orders, as a control."""
    return _TEXTS.proof(
        "convergence",
        local_orders=local_orders(shift),
        geometric=geometric(),
        within_the_bound=[_within_the_bound(eta, eta + shift) for eta in ETAS],
    )


def local_orders(shift: int) -> list[Check]:
    """Check that the local error is of order η + 1 + shift exactly, for both systems."""
    return [_local_order(name, eta, eta + shift) for name in examples.SYSTEMS for eta in ETAS]


def _local_order(name: str, eta: int, claimed: int) -> Check:
    order = convergence_of(lie_map(examples.with_symbols(name), eta))
    return Check(
        f"{name}, lie{eta}: the local error is of order `h^{claimed + 1}` exactly",
        order.decided and order.order == claimed,
        f"agrees with the exact flow up to `h^{order.order}`",
    )


def _within_the_bound(eta: int, order: int) -> Check:
    """Check the proof's bound on the oscillator.

    There M = 1, and L ≤ (e^h − 1)/h, as the norm of every Xⁿ is 1.
    """
    ratios, holds = [], True
    for steps in STEPS:
        error = examples.final_error(eta, steps)
        with examples.enclosures():
            h = rational_ball(Fraction(1, steps))
            lipschitz = (h.exp() - 1) / h
            # M h^η/(η+1)! (e^(LT) − 1)/L with M = T = 1.
            bound = h**order / math.factorial(order + 1) * (lipschitz.exp() - 1) / lipschitz
            holds = holds and bool(error <= bound)
            ratios.append(f"`{(error / h**order).mid().str(5, radius=False)}`")
    return Check(
        f"oscillator, lie{eta}, T = 1: |error|/`h^{order}` for N = {_list_numbers(STEPS)} lies "
        f"below the proof's bound",
        holds,
        ", ".join(ratios),
        BALLS,
    )


def _list_numbers(numbers: Sequence[int]) -> str:
    return ", ".join(map(str, numbers))


def eq_10(fixed: bool = True) -> Argument:
    """Refute Eq. 10 with e_n, n = η, in its middle; `fixed` False: with e_k, as it must read."""
    eta, ratios = 1, []
    with examples.enclosures():
        for steps in STEPS:
            h = rational_ball(Fraction(1, steps))
            end = examples.final_error(eta, steps)
            # As printed, e_n is the error after n = η steps; it must be that after k = N − 1.
            before = abs(examples.errors(eta, Fraction(1, steps), eta if fixed else steps - 1)[-1])
            ratios.append((end - (h * _LIPSCHITZ).exp() * before) / h ** (eta + 1))
    grows = all(bool(b > 5 * a) for a, b in pairwise(ratios))
    ratio_texts = ", ".join(f"`{r.mid().str(4, radius=False)}`" for r in ratios)
    recursion = Check(
        f"oscillator, lie{eta}, T = 1: (`e_N` − `e^h` "
        f"`e_{eta if fixed else 'N−1'}`)/`h^{eta + 1}`, which C must exceed, for N = "
        f"{_list_numbers(STEPS)}",
        grows,
        f"{ratio_texts}: {'grows like N' if grows else 'stays bounded'}",
        BALLS,
    )
    return _TEXTS.refutation(
        "eq_10",
        length_grows=_length_grows(),
        recursion=recursion,
        ratios=ratio_texts,
        numbers=_list_numbers(STEPS),
    )


def _length_grows(eta: int = 1) -> Check:
    """Check p'² + q'² = (1 + h²)(p² + q²) for lie1 on the oscillator; another `eta` fails."""
    hamiltonian = examples.oscillator()
    step_map, square = lie_map(hamiltonian, eta), P**2 + Q**2
    gap = step_map.p_next**2 + step_map.q_next**2 - (1 + H_STEP**2) * square
    h_p, h_q = (sympy.diff(hamiltonian.exact, z) for z in (P, Q))
    derivative = h_p * sympy.diff(square, Q) - h_q * sympy.diff(square, P)
    statement = "oscillator, lie1: p'² + q'² − (1 + h²)(p² + q²), and X(p² + q²)"
    return same(statement, [gap, derivative], ("p", "q", "h"))
