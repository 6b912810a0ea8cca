"""The order of ΔJ of lieη, and of S in n degrees of freedom."""

from verify.proof.assistant.stated import Shipped
from verify.proof.checked.in_theory.applies import Applies, eta_of, for_every
from verify.proof.checked.proved import Proved


def _theorems(proved: Proved) -> tuple[Shipped, ...]:
    name = "determinant_of_lie_in_plane" if proved.planar else "defect_of_lie"
    return (Shipped("Theorems", name),)


def _says(proved: Proved) -> str:
    eta = eta_of(proved) or 0
    by, last = ("D" if proved.timed else "X"), eta + 1
    defect, coefficient = "ΔJ", f"−div(`{by}^{eta}` f)/{last}!"
    if not proved.planar:
        parts = f"d(`{by}^{last}` `p_i`)∧d`q_i` + d`p_i`∧d(`{by}^{last}` `q_i`)"
        defect, coefficient = "S", f"−1/{last}! `Σ_i` ({parts})"
    return (
        f"{for_every(proved)} {defect} has no term below `h^{last}`, and that with `h^{last}` has "
        f"the coefficient {coefficient}"
    )


APPLIES = Applies(
    about="defect",
    applies=lambda proved: eta_of(proved) is not None and proved.preserves is not True,
    theorems=_theorems,
    says=_says,
)
