"""Symmetry, that a step of −h undoes a step of h: the defect is Φ_(−h)Φ_h(z) − z."""

from dataclasses import dataclass

from verify.structures.structure import StepValues, Structure, Value


@dataclass(frozen=True)
class Symmetric(Structure):
    """Symmetry of the step; every exact flow has it."""

    @property
    def defect_formula(self) -> str:
        """The formula of the defect of one step."""
        return "Φ_(−h)Φ_h(z) − z"

    def defect(self, step: StepValues) -> dict[str, Value]:
        """Return the components of the defect of one step, by their names."""
        return dict(zip(step.names, step.return_by(None), strict=True))
