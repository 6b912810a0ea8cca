"""A Runge–Kutta method with b_i a_ij + b_j a_ji = b_i b_j is symplectic."""

from verify.proof.checked.theory_marks import Applies
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.structures import AREA, SYMPLECTIC

_KEPT = {AREA: "det J = 1", SYMPLECTIC: "S = 0"}


def fulfils(every_h: object) -> bool:
    """Return True if the theorem's condition on the coefficients holds exactly."""
    if not isinstance(every_h, TreeConditions):
        return False
    conditions = every_h.area_conditions()
    return bool(conditions) and all(condition.holds for condition in conditions)


APPLIES = Applies(
    about="defect",
    applies=lambda proved: fulfils(proved.scheme.every_h),
    theorems=("Theorems.runge_kutta_is_symplectic",),
    says=lambda proved: (
        f"{_KEPT[proved.structure]} for every twice differentiable H wherever the stages have a "
        "differentiable solution, by `b_i` `a_ij` + `b_j` `a_ji` = `b_i` `b_j`"
    ),
    symplectic=True,
)
