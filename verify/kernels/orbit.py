"""The orbit of a scheme's map, and what it is an orbit of."""

from dataclasses import dataclass, field
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian


@dataclass(frozen=True)
class Orbit:
    """The iterates of a scheme's step of one size from (q, p), at t0 where H depends on time, for
    an H whose parameters have values.
    """

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    q: Fraction
    p: Fraction
    t0: Fraction = field(default=Fraction(0), kw_only=True)

    @property
    def start(self) -> dict[str, Fraction]:
        """What a kernel's run begins with."""
        return {"p": self.p, "q": self.q, "h": self.step_size, "t": self.t0}
