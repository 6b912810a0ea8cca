"""The vector field of a planar Hamiltonian in a ring, and what is derived along it."""

from dataclasses import dataclass
from functools import cached_property

from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.coordinates import PLANE
from verify.hamiltonians.lie_derivatives import LieDerivatives


@dataclass(frozen=True)
class VectorField:
    """p' = −H_q, q' = H_p (Eq. 1) in a ring; X = H_p ∂_q − H_q ∂_p is its Lie derivative.

    Where H depends on t the ring has that variable, and D = ∂_t + X takes the place of X in all
    that is derived along the flow. `of_energy`: H itself; None in a ring to which only its
    derivatives were carried.
    """

    ring: Ring
    h_p: Poly
    h_q: Poly
    of_energy: Poly | None = None

    @property
    def names(self) -> tuple[str, str]:
        """p and q."""
        return PLANE

    @property
    def slopes(self) -> tuple[Poly, Poly]:
        """p' and q'."""
        return -self.h_q, self.h_p

    @property
    def energy(self) -> Poly:
        """H, of a field that was made of it."""
        assert self.of_energy is not None  # noqa: S101 - the field of a Hamiltonian has it
        return self.of_energy

    @classmethod
    def of(cls, ring: Ring, hamiltonian: Poly) -> "VectorField":
        """That of H, an element of the ring."""
        return cls(ring, ring.diff(hamiltonian, "p"), ring.diff(hamiltonian, "q"), hamiltonian)

    def derive(self, y: Poly) -> Poly:
        """X y, the derivative of y along the flow; D y where H depends on time."""
        ring = self.ring
        along = self.h_p * ring.diff(y, "q") - self.h_q * ring.diff(y, "p")
        return ring.reduce(along + ring.diff(y, "t") if self.timed else along)

    @property
    def timed(self) -> bool:
        """Whether H depends on t."""
        return "t" in self.ring.places

    @cached_property
    def _powers(self) -> LieDerivatives:
        return LieDerivatives(self.ring, self.h_p, self.h_q)

    def power(self, name: str, n: int) -> Poly:
        """Xⁿ y of y = p or q, made once."""
        return self._powers.power(name, n)

    def taylor(self, name: str, most: int) -> dict[int, Poly]:
        """{n: Xⁿy/n!} of y = p or q, n = 0 … most, those that are not 0."""
        terms = {n: self._powers.term(name, n) for n in range(most + 1)}
        return {n: x for n, x in terms.items() if not x.is_zero()}

    def truncated(self, eta: int) -> tuple[Poly, Poly]:
        """Σ hⁿ/n! Xⁿp and Σ hⁿ/n! Xⁿq, n = 0 … η."""
        return self._powers.truncated(eta)

    def truncated_at(self, p_next: Poly, q_next: Poly) -> int | None:
        """The η whose `truncated` these very objects are; None for any other elements."""
        return self._powers.truncated_at(p_next, q_next)

    def delta_j(self, n: int, eta: int) -> Poly:
        """The coefficient of hⁿ in ΔJ of the map `truncated(eta)`, by direct expansion."""
        return self._powers.delta_j(n, eta)

    def separable(self) -> bool:
        """Whether H = T(p) + V(q): the mixed derivative H_pq is the zero function."""
        return self.ring.decide(self.ring.diff(self.h_p, "q")).zero is True
