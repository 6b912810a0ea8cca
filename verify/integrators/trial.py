"""A user's step or map with all that is asked of it, and what has been measured of it."""

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

Measured = tuple[Structure, Distances | None]  # no distances of a map, which is for no H


@dataclass
class Trial:
    """A user's step or map, the H that it is for, and the places at which it is tried."""

    step: UserMap
    hamiltonian: Hamiltonian | None
    places: list[Place]
    claims: Claims = NOTHING
    request: Request = NOWHERE
    _last: Measured | None = field(default=None, init=False, repr=False)

    def measure(self, how: str, ladder: Sequence[Fraction] = ()) -> Measured:
        """What is measured by dual numbers or by floats. Raises StepError, and what the user's code
        raises."""
        probe = probe_of(self.step, how)
        if isinstance(probe, DualProbe):
            must_agree(probe, self.places)
        structure, distances = structure_of(self.step, probe, self.places), None
        if self.hamiltonian is not None:
            places = list(dict.fromkeys(x.place for x in structure.readings))
            distances = distances_of(self.step, probe, self.hamiltonian, places, ladder)
        self._last = structure, distances
        return self._last

    @property
    def evidence(self) -> Measured | None:
        """Where a claim may be seen to fail: what was measured last, or is now; None where that
        cannot be."""
        for how in self.step.ways:
            if self._last is None:
                with suppress(Exception):  # the user's code may raise anything
                    self.measure(how)
        return self._last
