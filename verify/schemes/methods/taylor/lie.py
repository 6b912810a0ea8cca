"""The Lie-derivative scheme `lieη`: p' = Σ hⁿ/n! Xⁿp, q' = Σ hⁿ/n! Xⁿq, n = 0 … η (Eq. 2).

In the paper's notation, Eq. 5 has L_{H_p}(y) = H_p ∂y/∂q and L_{−H_q}(y) =
−H_q ∂y/∂p, two first-order operators whose sum is the Lie derivative X = H_p ∂_q − H_q ∂_p.
Eq. 4 recurs by both of them, L^n = L_{H_p}(L^{n−1}) + L_{−H_q}(L^{n−1}) = X L^{n−1}; Eq. 3 starts
it with L_{−H_q} p = −H_q = X p and L_{H_p} q = H_p = X q (where the paper writes L_{H_p}(p_k), its
∂q/∂p must be read as ∂q/∂q). So L^n_{−H_q} = X^n p and L^n_{H_p} = X^n q, and Eq. 2 is the Taylor
series of the flow, truncated after h^η.
"""

import re

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.schemes.maps.kinds.taylor_series import build
from verify.schemes.maps.step_map import StepMap
from verify.schemes.scheme import Scheme

EXAMPLES = ("lie1", "lie2", "lie3", "lie4", "lie5", "lie6")
MAX_ETA = 100
_SOURCE = "A New Area-Preserving Geometric Numerical Algorithm of Nonlinear Systems, Eq. 2–5"


def make(name: str) -> Scheme | None:
    """Return the scheme for a name such as `lie2`; InputError for η outside 1 … 100."""
    eta = eta_of(name)
    return None if eta is None else lie_series(f"lie{eta}", eta, source=_SOURCE)


def lie_series(name: str, eta: int, *, source: str) -> Scheme:
    """Return the scheme called `name` with the map of lieη."""
    return Scheme(name, order=eta, source=source, every_h=TaylorSeries(eta))


def eta_of(name: str) -> int | None:
    """Return the η of `lieη`; None for another name, InputError for η outside 1 … 100."""
    match = re.fullmatch(r"lie(\d+)", name, re.ASCII)
    if match is None:
        return None
    # The length is checked first: int() of a very long text takes quadratic time.
    if len(match[1]) > 3 or not 1 <= int(match[1]) <= MAX_ETA:
        raise InputError("scheme", name, f"η must be 1 … {MAX_ETA}")
    return int(match[1])


def lie_map(hamiltonian: Hamiltonian, eta: int) -> StepMap:
    """Return the step map of lieη, exact, for any H."""
    return build(TaylorSeries(eta), hamiltonian)
