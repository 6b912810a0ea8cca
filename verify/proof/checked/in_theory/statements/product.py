"""What small ΔJ make of Λ."""

from verify.proof.assistant.stated import Shipped
from verify.proof.checked.in_theory.applies import Applies

APPLIES = Applies(
    about="product",
    applies=lambda _: True,
    theorems=lambda _: (Shipped("Theorems", "error_over_many_steps"),),
    says=lambda _: "|`ΔJ_k`| ≤ ε in all N steps gives |Λ| ≤ `e^(Nε)` − 1",
)
