"""The leading coefficient of lieη telescopes for even η."""

from verify.proof.checked.proved_statement import ProvedStatement
from verify.proof.checked.theory_marks import Applies, by_flow, eta_of, for_every
from verify.structures import AREA, SYMPLECTIC


def _says(proved: ProvedStatement) -> str:
    telescoped = {AREA: f"{by_flow(proved)}·G, G", SYMPLECTIC: "a Lie derivative,"}[
        proved.structure
    ]
    return f"{for_every(proved)} the leading coefficient is {telescoped} in closed form"


APPLIES = Applies(
    about="telescopes",
    applies=lambda proved: (eta_of(proved) or 1) % 2 == 0 and proved.preserves is not True,
    theorems=("Theorems.lie_telescopes_for_even",),
    says=_says,
    in_plane=("Theorems.lie_telescopes_in_plane_for_even",),
)
