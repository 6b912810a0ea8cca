"""What is measured along a run of each structure that a step is meant to keep: its observables."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.scenes.observables import check_observables
from verify.structures.reading import KeepsRequest, read_structures

T = TypeVar("T")


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

    That the exact flow keeps them is not asked: the run shows whether the step does.
    """
    measured = []
    for claim in read_structures(request, system):
        structure = claim.structure.with_values(system.value_substitutions)
        if mistake := structure.mistake(system.coordinates):
            raise InputError("--keeps", structure.label, mistake)
        names = structure.observables(system.coordinates)
        check_observables(system, names)
        defect = structure.defect_formula
        measured.append(MeasuredStructure(structure.name, structure.label, defect, *names))
    return tuple(measured)
