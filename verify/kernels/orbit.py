"""The orbit of a scheme's map, and what it is an orbit of."""

from dataclasses import dataclass
from fractions import Fraction

from verify.hamiltonians.hamiltonian import Hamiltonian


@dataclass(frozen=True)
class Orbit:
    """The iterates of a scheme's step of one size from (q, p), for an H whose parameters have
    values.
    """

    hamiltonian: Hamiltonian
    scheme: str
    step_size: Fraction
    q: Fraction
    p: Fraction
