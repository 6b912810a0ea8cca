"""Eq. 8–11: the scheme converges with order η, by a joint Lipschitz constant; Eq. 10 as printed."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import sympy

from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.arb import rational_ball
from verify.papers.argument import BALLS, Argument, Check, proof, refutation, same
from verify.papers.elementary_identities import geometric
from verify.papers.lie_derivative_scheme import examples
from verify.proof.order_for_one_h import convergence_of
from verify.schemes.methods.taylor.lie import lie_map

ETAS = range(1, 5)
STEPS = (10, 100, 1000)
_LIPSCHITZ = 1  # of lie1 for the oscillator: ψ = f, and the norm of f' is 1


def convergence(shift: int = 0) -> Argument:
    """Prove that the global error is O(h^η); `shift` is added to the orders, as a control."""
    return proof(
        """
        it holds for every H of class `C^(η+1)`, with one Lipschitz constant for (p, q) together in
        place of Eq. 9's two

        Let H be of class `C^(η+1)` near the exact solution z̄(t), t₀ ≤ t ≤ `t_end`, and let K be
        the closed tube of some radius r around it in which this holds; T = `t_end` − t₀. Write Φ
        for the step and `z̄_k` for the exact solution at t₀ + kh.

        - Local error. Φ is the Taylor polynomial of degree η of the exact flow, so for a smooth H
          one step from the exact solution is off by C `h^(η+1)` at most; for both systems by no
          higher power. [Theorems.flow_has_taylor_series, local_orders]
        - By the remainder’s closed form (Lagrange), which needs η + 1 derivatives of H alone,
          ``|z̄_{k+1} − Φ(z̄_k)| ≤ M h^(η+1)/(η+1)!`` with M the maximum of |`X^(η+1)` z| over the
          solution.
        - Stability. Φ(z) = z + h ψ(z) with ψ = Σ `h^(n−1)`/n! Xⁿz, n = 1 … η, of class C¹; let L be
          the maximum of the norm of ψ' over K for 0 < h ≤ h₀. For a z within r of `z̄_k` the
          segment from `z̄_k` to z lies in K, so that ``|Φ(z̄_k) − Φ(z)| ≤ (1 + hL) |z̄_k − z|``.
          This is Eq. 9 in a norm of the plane, for both components together.
        - The triangle inequality, Eq. 8, gives for `E_k` = |`z̄_k` − `z_k`|, `E_0` = 0, as long as
          `E_k` ≤ r: ``E_{k+1} ≤ (1 + hL) E_k + M h^(η+1)/(η+1)!``. [Sums.size_of_sum]
        - By induction ``E_k ≤ M h^η/(η+1)! (e^(LT) − 1)/L`` for all kh ≤ T.
          [Product.errors_below_exp, geometric; tried within_the_bound]
        - Where h is so small that the right side is at most r, the numerical solution never leaves
          K before T, and the induction closes. Hence |`p̄_k` − `p_k`| and |`q̄_k` − `q_k`| are
          O(`h^η`) on [t₀, `t_end`].

        What fails on the way as it is printed: Eq. 7 calls |p̃ − p| the global error, which is |p̄
        − p|; Eq. 9 has the p-difference alone on its right side, and `p̃_k` in it for `p̄_k`; Eq.
        10 and 11 are of p alone and of q alone; Eq. 10 has `e_n` for `e_k`; and n in the exponents
        of Eq. 10 and 11 is η.
        """,
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
    return refutation(
        f"""
        with `e_n` in place of `e_k` the error would be O(`h^(η+1)`) after any number of steps; for
        the oscillator and η = 1 it is h/2 to leading order at T = 1 (C would have to be
        {ratio_texts} for N = {_list_numbers(STEPS)})

        In Eq. 10 n is the order η of the truncated exponential, as its exponent `h^(n+1)` and the
        text below it say.

        - `e_n` is the error after η steps, which is O(`h^(η+1)`) whatever k is; so Eq. 10 would
          bound `e_{{k+1}}` by O(`h^(η+1)`) for all k, one order better than Eq. 11.
        - For H = (p² + q²)/2 and η = 1 a step takes |z|² to (1 + h²) |z|², so that ``|z_k| = (1 +
          h^2)^(k/2) |z_0|``, while the exact solution keeps |z|. [length_grows]
        - So at T = 1 the norm of the error is at least, for h ≤ 1/2, ``(1 + h^2)^(1/(2h)) − 1 ≥
          h/2`` (Bernoulli), and one of its two components at least h/3, which no C h² bounds.
          [tried recursion]

        It is a misprint: with `e_k` for `e_n` the second inequality of Eq. 10 is 1 + hL ≤ `e^(hL)`,
        and Eq. 11 follows by iteration for any sequence with `e_{{k+1}}` ≤ (1 + hL) `e_k` + C
        `h^(η+1)`.
        """,
        length_grows=_length_grows(),
        recursion=recursion,
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
