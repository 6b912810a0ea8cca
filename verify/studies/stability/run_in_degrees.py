"""One run in n degrees of freedom, as trails follow it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.studies.stability.trail import State


@dataclass(frozen=True)
class RunInDegrees:
    """The first N steps from a state, p1 … pn, q1 … qn, at t0 where H depends on time."""

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    state: State
    steps: int
    t0: Fraction = Fraction(0)

    @property
    def time(self) -> Fraction:
        return self.steps * self.step_size

    @property
    def start(self) -> Mapping[str, Fraction]:
        """What a kernel's run begins with."""
        point = dict(zip(self.hamiltonian.coordinates, self.state, strict=True))
        return {**point, "h": self.step_size, "t": self.t0}

    def onwards(self, state: State, step: int, steps: int) -> "RunInDegrees":
        t0 = self.t0 + step * self.step_size
        return replace(self, state=state, steps=steps, t0=t0)

    def shortened(self, steps: int) -> "RunInDegrees":
        return replace(self, steps=steps)
