"""A user's step or map with its claims and places, and what has been measured of it."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.measures.order import Distances, distances_of, probe_of
from verify.integrators.measures.structure import Structure, structure_of
from verify.integrators.measures.survey import NOWHERE, Request
from verify.integrators.places.place import Place
from verify.integrators.probes.agreement import must_agree
from verify.integrators.probes.duals import DualProbe
from verify.integrators.results import NOTHING, Claims
from verify.integrators.user_code.user_map import UserMap

Measurement = tuple[Structure, Distances | None]  # no distances of a map, which is for no H


@dataclass
class Trial:
    """A user's step or map, the H that it is for, and the places at which it is tried."""

    step: UserMap
    hamiltonian: Hamiltonian | None
    places: list[Place]
    claims: Claims = NOTHING
    request: Request = NOWHERE
    _last: Measurement | None = field(default=None, init=False, repr=False)

    def measure(self, how: str, ladder: Sequence[Fraction] = ()) -> Measurement:
        """Measure the structure and the distances, by dual numbers or by floats. Raises StepError,
        and what the user's code raises."""
        probe = probe_of(self.step, how)
        if isinstance(probe, DualProbe):
            # Dual numbers may take another branch than floats do: what they measure would then be
            # of another map.
            must_agree(probe, self.places)
        structure, distances = structure_of(self.step, probe, self.places), None
        if self.hamiltonian is not None:
            places = list(dict.fromkeys(x.place for x in structure.readings))
            distances = distances_of(self.step, probe, self.hamiltonian, places, ladder)
        self._last = structure, distances
        return self._last

    @property
    def evidence(self) -> Measurement | None:
        """The measurement in which a claim may be seen to fail: the last one, or a new one; None
        where none succeeds."""
        for how in self.step.ways:
            if self._last is None:
                with suppress(Exception):  # the user's code may raise anything
                    self.measure(how)
        return self._last
