"""Sentences of Section 2.1 beside its equations: whose the method is, and why it is as it is."""

import sympy

from verify.algebra.symbols import P, Q
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import Argument, ArgumentTexts, Check, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian
from verify.papers.lie_derivative_scheme.lie_series import eq_4, powers_of

_TEXTS = ArgumentTexts(__file__)


def taylor_method() -> Argument:
    """Prove that lieη is the Taylor series method of order η, step for step."""
    return _TEXTS.proof("taylor_method", powers_of=map(powers_of, ("p", "q")))


def partitioned(sign: int = -1) -> Argument:
    """Prove that the derivative along Eq. 1 is a sum of two, one from each of its equations."""
    flow = flow_of_every_hamiltonian(1, ["y", "y_p", "y_q"])
    ring = flow.ring
    ring.set_gradient("y", p=ring["y_p"], q=ring["y_q"])
    parts = flow.h_p * ring["y_q"] + sign * flow.h_q * ring["y_p"]
    return _TEXTS.proof(
        "partitioned",
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
    return _TEXTS.refutation(
        "partitioned_separable",
        check=Check(f"H = `{formula}`: `H_pq` is not 0", mixed != 0, f"`{mixed}`"),
        vanishes=vanishes(
            "Eq. 4 and 5 from L q = `H_p`, less X² q, for a generic H",
            eq_4(flow, second[1]) - second[2],
        ),
        formula=formula,
    )


def higher_derivatives() -> Argument:
    """Prove that L² is a derivative of H_p and of −H_q."""
    flow = flow_of_every_hamiltonian(2)
    first_derivatives = {"q": flow.h_p, "p": -flow.h_q}
    gaps = [
        eq_4(flow, y) - flow.lie_derivatives(name, 2)[2] for name, y in first_derivatives.items()
    ]
    return _TEXTS.proof(
        "higher_derivatives",
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
    return _TEXTS.refutation(
        "higher_derivatives_nonlinearity", is_linear=is_linear, is_curved=is_curved
    )
