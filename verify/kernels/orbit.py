"""The orbit of a scheme's map, and what it is an orbit of."""

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.start import point_of


@dataclass(frozen=True)
class Orbit:
    """The iterates of a scheme's step of one size from (q, p), at t0 where H depends on time, for
    an H whose parameters have values. q and p are Fractions; in n degrees of freedom a tuple each.
    """

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    q: Any
    p: Any
    t0: Fraction = field(default=Fraction(0), kw_only=True)

    @property
    def start(self) -> dict[str, Fraction]:
        """What a kernel's run begins with."""
        point = point_of(self.hamiltonian, self.q, self.p)
        return {**point, "h": self.step_size, "t": self.t0}
