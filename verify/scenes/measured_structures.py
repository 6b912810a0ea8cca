"""What is measured along a run of each structure that a step is meant to keep: its observables."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

from verify.algebra.expressions.formula_text import to_text
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.observables import check_observables
from verify.structures import AREA, CanonicalForm
from verify.structures.first_integral import FirstIntegral
from verify.structures.reading import KeepsRequest, read_structures
from verify.structures.reversible import Reversible
from verify.structures.structure import Structure
from verify.structures.volume import Volume

T = TypeVar("T")
_MEASURED = "area, symplectic and volume as they are, first integrals, reversible"


@dataclass(frozen=True)
class MeasuredStructure:
    """A structure with the names of its observables.

    `at_end`: of what has accumulated at the end of the run; `largest`: of the greatest on the way,
    or "" if there is none.
    """

    structure: str
    label: str
    defect: str
    at_end: str
    largest: str = ""

    @property
    def observables(self) -> tuple[str, ...]:
        """The names of the observables."""
        return tuple(filter(None, (self.at_end, self.largest)))

    def select(self, values: Mapping[str, T]) -> dict[str, T | None]:
        """Return the values of the run, by `at_end` and `largest`."""
        return {"at_end": values.get(self.at_end), "largest": values.get(self.largest)}


def measured_structures(
    system: Hamiltonian, request: KeepsRequest
) -> tuple[MeasuredStructure, ...]:
    """Return the requested structures with their observables.

    That the exact flow keeps them is not asked: the run shows whether the step does. Raises
    InputError for a structure of which a run measures nothing.
    """
    measured = []
    for claim in read_structures(request, system):
        structure = claim.structure.with_values(system.value_substitutions)
        if mistake := structure.mistake(system.coordinates):
            raise InputError("--keeps", structure.label, mistake)
        names = _observables_of(structure)
        check_observables(system, names)
        defect = structure.defect_formula
        measured.append(MeasuredStructure(structure.name, structure.label, defect, *names))
    return tuple(measured)


def _observables_of(structure: Structure) -> tuple[str, ...]:
    if isinstance(structure, FirstIntegral):
        if structure.name == "energy":
            return "energy_error", "energy_error_max"
        formula = to_text(structure.integral)
        return f"integral_error: {formula}", f"integral_error_max: {formula}"
    if isinstance(structure, CanonicalForm):
        return structure.of_run, structure.over_run
    if isinstance(structure, Volume) and structure.density == 1:
        return AREA.of_run, AREA.over_run
    if isinstance(structure, Reversible):
        return (f"way_back: {', '.join(map(to_text, structure.reflection))}",)
    problem = f"is not measured along a run, which measures {_MEASURED}"
    raise InputError("--keeps", structure.name, problem)
