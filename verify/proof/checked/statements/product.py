"""The bound of Λ by small ΔJ."""

from verify.proof.checked.theory_marks import Applies

APPLIES = Applies(
    about="product",
    applies=lambda _: True,
    theorems=("Theorems.error_over_many_steps",),
    says=lambda _: "|`ΔJ_k`| ≤ ε in all N steps gives |Λ| ≤ `e^(Nε)` − 1",
)
