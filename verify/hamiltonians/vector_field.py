"""The vector field of a planar Hamiltonian in a ring, and what is derived along it.

What is derived along a vector field, each part made once for all the schemes that need it.

By keys rather than in lists, so that two threads may make the same part.
"""

import math
from dataclasses import dataclass
from functools import cached_property

from verify.algebra.ring import Poly, Ring
from verify.hamiltonians.coordinates import PLANE

_MOST_KEPT = 2000  # terms of a coefficient of ΔJ, beyond which it is made anew for each scheme


class LieDerivatives:
    """Xⁿp and Xⁿq of X = H_p ∂_q − H_q ∂_p, their gradients, and ΔJ of their Taylor polynomials.

    In a ring with t it is D = ∂_t + X in place of X.
    """

    def __init__(self, ring: Ring, h_p: Poly, h_q: Poly) -> None:
        self.ring, self.h_p, self.h_q = ring, h_p, h_q
        self._powers: dict[tuple[str, int], Poly] = {}
        self._terms: dict[tuple[str, int], Poly] = {}
        self._gradients: dict[tuple[str, int], tuple[Poly, Poly]] = {}
        self._truncated: dict[int, tuple[Poly, Poly]] = {}
        self._delta_j: dict[tuple[int, int], Poly] = {}

    def power(self, name: str, n: int) -> Poly:
        """Xⁿ y of y = p or q."""
        if (name, n) in self._powers:
            return self._powers[name, n]
        if n == 0:
            found = self.ring.variable(name)
        elif n == 1:
            found = self.ring.reduce(-self.h_q if name == "p" else self.h_p)
        else:
            y_p, y_q = self._gradient(name, n - 1)
            found = self.h_p * y_q - self.h_q * y_p
            if "t" in self.ring.places:
                found += self.ring.diff(self.power(name, n - 1), "t")
            found = self.ring.reduce(found)
        self._powers[name, n] = found
        return found

    def term(self, name: str, n: int) -> Poly:
        """Xⁿ y/n!."""
        if n < 2:
            return self.power(name, n)
        if (name, n) not in self._terms:
            self._terms[name, n] = self.power(name, n) / math.factorial(n)
        return self._terms[name, n]

    def truncated(self, eta: int) -> tuple[Poly, Poly]:
        """Σ hⁿ/n! Xⁿp and Σ hⁿ/n! Xⁿq, n = 0 … η."""
        if eta not in self._truncated:
            if eta == 0:
                return self.power("p", 0), self.power("q", 0)
            below, h = self.truncated(eta - 1), self.ring.variable("h") ** eta
            p, q = (x + h * self.term(name, eta) for x, name in zip(below, "pq", strict=True))
            self._truncated.setdefault(eta, (p, q))  # another thread's own may be there by now
        return self._truncated[eta]

    def truncated_at(self, p_next: Poly, q_next: Poly) -> int | None:
        """The η whose `truncated` these very objects are; None for any other elements."""
        for eta, (p, q) in list(self._truncated.items()):
            if p is p_next and q is q_next:
                return eta
        return None

    def delta_j(self, n: int, eta: int) -> Poly:
        """The coefficient of hⁿ in det ∂(p', q')/∂(p, q) − 1 of the map `truncated(eta)`."""
        key = n, min(n, eta)  # higher powers of X do not occur in it
        if key in self._delta_j:
            return self._delta_j[key]
        total = -self.ring.one if n == 0 else self.ring.zero
        if 0 < n <= eta:
            # Beside ΔJ of the map without hⁿ: the two brackets with p or q itself.
            (x_p, _), (_, y_q) = self._gradient("p", n), self._gradient("q", n)
            total = self.delta_j(n, n - 1) + (x_p + y_q) / math.factorial(n)
        else:
            for k in range(max(0, n - eta), min(n, eta) + 1):
                (x_p, x_q), (y_p, y_q) = self._gradient("p", k), self._gradient("q", n - k)
                total += (x_p * y_q - x_q * y_p) / (math.factorial(k) * math.factorial(n - k))
        total = self.ring.reduce(total)
        if len(total) <= _MOST_KEPT:
            self._delta_j[key] = total
        return total

    def _gradient(self, name: str, n: int) -> tuple[Poly, Poly]:
        if (name, n) not in self._gradients:
            diff, y = self.ring.diff, self.power(name, n)
            self._gradients[name, n] = diff(y, "p"), diff(y, "q")
        return self._gradients[name, n]


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
