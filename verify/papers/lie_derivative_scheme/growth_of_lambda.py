"""How Λ grows for even η: bounded at h^η, and in proportion to the time one power of h later."""

from verify.papers.argument import Argument, ArgumentTexts, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian

_TEXTS = ArgumentTexts(__file__)


def growth_of_lambda() -> Argument:
    """Prove log(1 + Λ) = h^η [G] + h^(η+1) (∫ g dt − ½ [X G]) + O(h^(η+2) T) for even η."""
    flow = flow_of_every_hamiltonian(4)
    telescopes = vanishes(
        "the coefficient of h³ in ΔJ of lie2 is X·G for a generic H, with G = det Hess H/2",
        flow.delta_j_gaps(2, h3=flow.derive(flow.hessian_determinant / 2))[2],
    )
    return _TEXTS.proof("growth_of_lambda", telescopes=telescopes)
