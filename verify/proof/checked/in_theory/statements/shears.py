"""That kicks and drifts in turn are symplectic."""

from verify.proof.assistant.stated import Shipped
from verify.proof.checked.in_theory.applies import Applies
from verify.proof.checked.proved import Proved
from verify.schemes.conditions.splitting_conditions import Splitting


def _theorems(proved: Proved) -> tuple[Shipped, ...]:
    step = Shipped("Theorems", "shears_are_symplectic")
    return (
        (step, Shipped("Theorems", "symplectic_is_area_preserving")) if proved.planar else (step,)
    )


def _says(proved: Proved) -> str:
    det = ", so that det J = 1" if proved.planar else ""
    return f"kicks and drifts in turn are symplectic, for every twice differentiable T and V{det}"


APPLIES = Applies(
    about="defect",
    applies=lambda proved: isinstance(proved.scheme.every_h, Splitting),
    theorems=_theorems,
    says=_says,
)
