"""Symmetry, that a step of −h undoes a step of h: the defect is Φ_(−h)Φ_h(z) − z."""

from dataclasses import dataclass

from verify.structures.structure import StepValues, Structure, Value


@dataclass(frozen=True)
class Symmetric(Structure):
    """Symmetry of the step; every exact flow has it."""

    @property
    def defect_formula(self) -> str:
        return "Φ_(−h)Φ_h(z) − z"

    def defect(self, step: StepValues) -> dict[str, Value]:
        return dict(zip(step.names, step.return_by(None), strict=True))
