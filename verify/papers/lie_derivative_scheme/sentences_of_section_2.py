"""Sentences of Section 2.1 beside its equations: whose the method is, and why it is as it is."""

import sympy

from verify.algebra.symbols import P, Q
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import Argument, Check, proof, refutation, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.lie_derivative_scheme.lie_series import eq_4, powers_of


def taylor_method() -> Argument:
    """Prove that lieη is the Taylor series method of order η, step for step."""
    return proof(
        """
        for every H a step of lieη is the Taylor polynomial of degree η of the exact flow: the
        Taylor series method of order η, which references 23 to 29 of the paper apply as the Lie
        derivative method

        - By Eq. 2, 4 and 5 ``z_{k+1} = Σ_{n=0}^{η} h^n/n! X^n z``, X the derivative along the
          motion (see the claim on Eq. 2, 4 and 5). [powers_of]
        - This is the definition of the Taylor series method of order η for z' = f(z): Xⁿz is the
          n-th time derivative of the solution.

        The four criteria, and what the paper says of areas, may be new; they are judged each by
        itself. Who was first, a computation cannot say.
        """,
        powers_of=map(powers_of, ("p", "q")),
    )


def partitioned(sign: int = -1) -> Argument:
    """Prove that the derivative along Eq. 1 is a sum of two, one from each of its equations."""
    flow = flow_of_every_hamiltonian(1, ["y", "y_p", "y_q"])
    ring = flow.ring
    ring.set_gradient("y", p=ring["y_p"], q=ring["y_q"])
    parts = flow.h_p * ring["y_q"] + sign * flow.h_q * ring["y_p"]
    return proof(
        """
        Eq. 1 is two equations, and the derivative along the motion the sum of one term from each,
        `L_{H_p}` + `L_{−H_q}` = `H_p` ∂/∂q − `H_q` ∂/∂p, for every H

        - By the chain rule ``dy/dt = H_p ∂y/∂q − H_q ∂y/∂p`` along Eq. 1, and the two terms are Eq.
          3 (as meant) and 5. [vanishes]
        """,
        vanishes=vanishes(
            "`H_p` ∂y/∂q − `H_q` ∂y/∂p less X y, for a generic H and y",
            parts - flow.derive(ring["y"]),
        ),
    )


def partitioned_separable(formula: str = "p*q + p**2*q**2") -> Argument:
    """Refute that Eq. 2–5 need an H that is a sum of a function of p and one of q."""
    hamiltonian = Hamiltonian.parse(formula)
    mixed = sympy.expand(sympy.diff(hamiltonian.exact, P, Q))
    flow = flow_of_every_hamiltonian(2)
    second = flow.lie_derivatives("q", 2)
    return refutation(
        f"""
        Eq. 3 to 5 hold for every H(p, q), such as `pq + p²q²`, which is no sum of a function of p
        and a function of q

        - H = `{formula}` has ``H_{{pq}} ≠ 0``, so that it is no such sum. [check]
        - Eq. 4 and 5 are the derivative along the motion for a generic H, so for this one.
          [vanishes]
        """,
        check=Check(f"H = `{formula}`: `H_pq` is not 0", mixed != 0, f"`{mixed}`"),
        vanishes=vanishes(
            "Eq. 4 and 5 from L q = `H_p`, less X² q, for a generic H",
            eq_4(flow, second[1]) - second[2],
        ),
    )


def higher_derivatives() -> Argument:
    """Prove that L² is a derivative of H_p and of −H_q."""
    flow = flow_of_every_hamiltonian(2)
    first_derivatives = {"q": flow.h_p, "p": -flow.h_q}
    gaps = [
        eq_4(flow, y) - flow.lie_derivatives(name, 2)[2] for name, y in first_derivatives.items()
    ]
    return proof(
        """
        `L²` q = L `H_p` and `L²` p = −L `H_q`, and so on: derivatives of functions of p and q

        - By Eq. 4 ``L^2 q = X H_p, L^2 p = −X H_q``. [vanishes]
        """,
        vanishes=vanishes(
            "Eq. 4 from `H_p` and −`H_q`, less X² q and X² p, for a generic H", *gaps
        ),
    )


def higher_derivatives_nonlinearity(
    linear: str = "p**2/2 + p*q + q**2", curved: str = "p**2/2 + q**4/4"
) -> Argument:
    """Refute that nonlinearity is the reason, by a linear and a nonlinear system."""
    first, second = (Hamiltonian.parse(formula).exact for formula in (linear, curved))
    rates = [sympy.diff(first, z) for z in (P, Q)]
    slopes = [sympy.diff(x, y, z) for x in rates for y in (P, Q) for z in (P, Q)]
    is_linear = Check(
        f"H = `{linear}`: the second derivatives of `H_p` and `H_q`, and `H_p` is neither p nor q",
        not any(slopes) and rates[0] not in (P, Q),
        f"0; `H_p` = `{rates[0]}`",
    )
    force, speed = sympy.diff(second, Q), sympy.diff(second, P)
    is_curved = Check(
        f"H = `{curved}`: `H_p` is p, and `H_q` is not linear",
        speed == P and sympy.diff(force, Q, Q) != 0,
        f"`{speed}`, `{force}`",
    )
    return refutation(
        """
        the linear system of H = `p²/2 + pq + q²` has L q = p + q, a function, whose derivative `L²`
        q is; and the nonlinear one of H = `p²/2 + q⁴/4` has L q = p, a variable

        - The system of the first H is linear, and L q = `H_p` is neither p nor q. [is_linear]
        - That of the second is not, and L q = p, so that `L²` q = L p is the derivative of a
          variable. [is_curved]
        """,
        is_linear=is_linear,
        is_curved=is_curved,
    )
