"""A stage whose weights fulfil the condition is symplectic, and so are stages in turn."""

from verify.proof.checked.theory_marks import Applies
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations


def stages_fulfil(every_h: object) -> bool:
    """Return True if the theorem's condition on weights holds exactly for each stage."""
    if not isinstance(every_h, StageEquations):
        return False
    return all(_fulfils(stage, separable=every_h.separable) for stage in every_h.stages)


def _fulfils(stage: Stage, *, separable: bool) -> bool:
    """Return True if k d (1 − s − u) = 0, and k = d or H = T(p) + V(q)."""
    weight = stage.kick * stage.drift * (1 - stage.at_p - stage.at_q)
    return weight == 0 and (separable or stage.kick == stage.drift)


APPLIES = Applies(
    about="defect",
    applies=lambda proved: stages_fulfil(proved.scheme.every_h),
    theorems=("SymplecticMethods.stage_of_hamiltonian", "Symplectic.steps_symplectic"),
    says=lambda _: (
        "stages of such weights in turn are symplectic wherever they have a differentiable solution"
    ),
    symplectic=True,
    so=", so that det J = 1",
)
