"""Kicks and drifts in turn are symplectic."""

from verify.proof.checked.theory_marks import Applies
from verify.schemes.conditions.splitting_conditions import Splitting

APPLIES = Applies(
    about="defect",
    applies=lambda proved: isinstance(proved.scheme.every_h, Splitting),
    theorems=("Theorems.shears_are_symplectic",),
    says=lambda _: (
        "kicks and drifts in turn are symplectic, for every twice differentiable T and V"
    ),
    symplectic=True,
    so=", so that det J = 1",
)
