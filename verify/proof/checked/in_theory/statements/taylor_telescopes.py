"""That the leading coefficient of lieη telescopes for even η."""

from verify.proof.assistant.stated import Shipped
from verify.proof.checked.in_theory.applies import Applies, eta_of, for_every
from verify.proof.checked.proved import Proved


def _says(proved: Proved) -> str:
    by = "D" if proved.timed else "X"
    known = f"{by}·G, G in closed form" if proved.planar else "a Lie derivative, in closed form"
    return f"{for_every(proved)} the leading coefficient is {known}"


APPLIES = Applies(
    about="telescopes",
    applies=lambda proved: (eta_of(proved) or 1) % 2 == 0 and proved.preserves is not True,
    theorems=lambda proved: (
        Shipped("Theorems", "lie_telescopes_in_plane_for_even")
        if proved.planar
        else Shipped("Theorems", "lie_telescopes_for_even"),
    ),
    says=_says,
)
