"""The order of ΔJ of lieη, and of S in n degrees of freedom."""

from verify.proof.checked.proved_statement import ProvedStatement
from verify.proof.checked.theory_marks import (
    Applies,
    by_flow,
    divergence,
    eta_of,
    first_term,
    is_lie,
)
from verify.structures import AREA, SYMPLECTIC


def _says(proved: ProvedStatement) -> str:
    last = (eta_of(proved) or 0) + 1
    derivative = f"{by_flow(proved)}^{last}"
    parts = f"d(`{derivative}` `p_i`)∧d`q_i` + d`p_i`∧d(`{derivative}` `q_i`)"
    form = f"−1/{last}! `Σ_i` ({parts})"
    coefficient = {AREA: divergence(proved), SYMPLECTIC: form}[proved.structure]
    return first_term(proved, proved.structure.symbol, coefficient)


APPLIES = Applies(
    about="defect",
    applies=is_lie,
    theorems=("Theorems.defect_of_lie",),
    says=_says,
    in_plane=("Theorems.determinant_of_lie_in_plane",),
)
