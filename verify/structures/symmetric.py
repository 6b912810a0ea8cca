"""Symmetry, that a step of −h undoes a step of h: the defect is Φ_(−h)Φ_h(z) − z."""

from collections.abc import Sequence
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

    def observables(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the observable that is the way back of a run, by steps of −h."""
        return ("way_back: -h",)


SYMMETRIC = Symmetric("symmetric", "symmetric: a step of −h undoes a step of h")
