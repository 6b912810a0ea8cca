"""The vector field of H(p1 … pn, q1 … qn), for one H or for every H at once; derivatives along it.

z = (p1 … pn, q1 … qn) and z′ = f, with f = −∂H/∂q for p and ∂H/∂p for q. X = f·∂ is the Lie
derivative; if H depends on t, D = ∂_t + X takes its place. The components of the field of one H are
in a ring with the coordinates; those for every H are in the ring of H's derivatives, the jets.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property, lru_cache

from verify.algebra.embedding import MAX_TERMS
from verify.algebra.jets import Jets, JetsInDegrees
from verify.algebra.power_series import CoefficientRing, Derivatives
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.coordinates import numbered_names
from verify.hamiltonians.equations import Equations
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy


class VectorField(ABC):
    """Derivatives along a field over any ring; `names` are p1 … pn, q1 … qn."""

    names: tuple[str, ...]

    @property
    @abstractmethod
    def ring(self) -> CoefficientRing:
        """The ring of all elements, with a variable for each name, and t if H has it."""

    @property
    @abstractmethod
    def slopes(self) -> tuple[Poly, ...]:
        """The components of f, one for each name."""

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom, half the number of names."""
        return len(self.names) // 2

    @property
    def timed(self) -> bool:
        """True if H depends on t."""
        return "t" in self.ring.places

    @cached_property
    def start(self) -> tuple[Poly, ...]:
        """The coordinates z, as elements of the ring."""
        return tuple(map(self.ring.variable, self.names))

    @cached_property
    def derivatives(self) -> tuple[Derivatives, ...]:
        """The components of f, with their cached derivatives."""
        return tuple(Derivatives(self.ring, x) for x in self.slopes)

    def derive(self, y: Poly) -> Poly:
        """Return X y; D y if H depends on time."""
        total = self.ring.diff(y, "t") if self.timed else self.ring.zero
        for slope, name in zip(self.slopes, self.names, strict=True):
            if not slope.is_zero():
                total += slope * self.ring.diff(y, name)
        return self.ring.reduce(total)

    @cached_property
    def _powers(self) -> dict[int, tuple[Poly, ...]]:
        return {0: self.start, 1: tuple(map(self.ring.reduce, self.slopes))}

    def power(self, n: int) -> tuple[Poly, ...]:
        """Return Xⁿz, computed once."""
        if n not in self._powers:
            # Two threads may compute the same power; setdefault keeps the first result.
            self._powers.setdefault(n, tuple(map(self.derive, self.power(n - 1))))
        return self._powers[n]

    def term(self, n: int) -> tuple[Poly, ...]:
        """Return Xⁿz/n!, the coefficient of hⁿ in the exact flow."""
        return tuple(x / math.factorial(n) for x in self.power(n))

    def gradients(self, n: int) -> tuple[tuple[Poly, ...], ...]:
        """Return the matrix ∂(Xⁿz/n!)/∂z by rows, computed once."""
        if n not in self._gradients:
            self._gradients.setdefault(n, tuple(map(self.gradient, self.term(n))))
        return self._gradients[n]

    @cached_property
    def _gradients(self) -> dict[int, tuple[tuple[Poly, ...], ...]]:
        return {}

    def gradient(self, x: Poly) -> tuple[Poly, ...]:
        """Return ∂x/∂z."""
        return tuple(self.ring.diff(x, name) for name in self.names)


class PlainField(VectorField):
    """A field in a ring with the coordinates, h, t if the system has it, and parameters."""

    def __init__(self, ring: Ring, names: tuple[str, ...], slopes: Sequence[Poly]) -> None:
        self._ring, self.names, self._slopes = ring, names, tuple(slopes)

    @property
    def ring(self) -> Ring:
        """The ring, in which zero is decided."""
        return self._ring

    @property
    def slopes(self) -> tuple[Poly, ...]:
        """The components of f, one for each name."""
        return self._slopes

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom; of a field without an H that of its coordinates."""
        # Two at least: what one degree of freedom has is of p and q.
        return max(len(self.names), 2)

    def flow_changes(self, eta: int) -> list[Poly]:
        """Return Σ hⁿ/n! Xⁿz, n = 1 … η: z′ − z of `lieη`, the exact flow's Taylor polynomial."""
        h, total = self.ring.variable("h"), [self.ring.zero] * len(self.names)
        for n in range(1, eta + 1):
            total = [x + h**n * y for x, y in zip(total, self.term(n), strict=True)]
        return total

    def shears(self, size: Poly | Fraction, places: Sequence[int]) -> list[Poly]:
        """Return the components of h · size · f at these places."""
        exact = self.ring.constant(size) if isinstance(size, Fraction) else size
        share = self.ring.variable("h") * exact
        return [self.ring.reduce(share * self.slopes[k]) for k in places]

    @cached_property
    def quadratic(self) -> bool:
        """True if no second derivative of H has a coordinate, and H has no t."""
        second = (y for x in self.slopes for y in self.gradient(x))
        depends = self.ring.depends
        return not self.timed and not any(depends(y, name) for y in second for name in self.names)

    @property
    def separable(self) -> bool:
        """False: a plain field has no H = T(p) + V(q)."""
        return False


class CanonicalField(PlainField):
    """The canonical field of one H, `energy`, an element of its ring."""

    def __init__(self, ring: Ring, names: tuple[str, ...], energy: Poly) -> None:
        super().__init__(ring, names, ())
        self.energy = energy

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom, half the number of names."""
        return len(self.names) // 2

    @cached_property
    def slopes(self) -> tuple[Poly, ...]:
        """The components of f, one for each name."""
        # z = (p, q): the first n components are p' = −∂H/∂q, the others q' = ∂H/∂p.
        n, diff = self.degrees, self.ring.diff
        forces = [-diff(self.energy, name) for name in self.names[n:]]
        return (*forces, *(diff(self.energy, name) for name in self.names[:n]))

    @cached_property
    def separable(self) -> bool:
        """True if H = T(p) + V(q): all mixed derivatives are the zero function."""
        n, ring = self.degrees, self.ring
        mixed = (ring.diff(v, q) for v in self.slopes[n:] for q in self.names[n:])
        return all(ring.vanishes(x) is True for x in mixed)


def field_of(
    hamiltonian: Hamiltonian, *expressions: sympy.Expr, most_terms: int = MAX_TERMS
) -> tuple[PlainField, list[Poly]]:
    """Return the field of a system, and other expressions as elements of its ring.

    Symbols that the system does not have are variables of the ring too. Raises InputError as
    `Hamiltonian.embed_in_ring` does.
    """
    if not expressions and most_terms == MAX_TERMS:
        return _cached_field(hamiltonian), []
    return _new_field(hamiltonian, expressions, most_terms)


# Proofs of several schemes for one H share its field. The cache is small, since a field keeps all
# derivatives along it.
@lru_cache(maxsize=8)
def _cached_field(hamiltonian: Hamiltonian) -> PlainField:
    return _new_field(hamiltonian, (), MAX_TERMS)[0]


def _new_field(
    hamiltonian: Hamiltonian, expressions: Sequence[sympy.Expr], most_terms: int
) -> tuple[PlainField, list[Poly]]:
    names = hamiltonian.coordinates
    if isinstance(hamiltonian, Equations):
        ring, slopes, elements = hamiltonian.embed_slopes(*expressions, most_terms=most_terms)
        return PlainField(ring, names, slopes), elements
    # Without expressions the defaults may be read from a record.
    limit = {} if not expressions and most_terms == MAX_TERMS else {"most_terms": most_terms}
    ring, energy, elements = hamiltonian.embed_in_ring(*expressions, **limit)
    return CanonicalField(ring, names, energy), elements


def canonical_field(
    hamiltonian: Hamiltonian, *expressions: sympy.Expr, most_terms: int = MAX_TERMS
) -> tuple[CanonicalField, list[Poly]]:
    """Return the field of `hamiltonian.exact`, as `field_of`; InputError for equations."""
    field, elements = field_of(hamiltonian, *expressions, most_terms=most_terms)
    return require_canonical(field), elements


def require_canonical(field: PlainField) -> CanonicalField:
    """Return the field itself; InputError if it is not that of an H."""
    if not isinstance(field, CanonicalField):
        slopes = ", ".join(map(field.ring.text, field.slopes))
        raise InputError("field", slopes, "has no H, which is needed here")
    return field


def energy_of(hamiltonian: Hamiltonian) -> tuple[Ring, Poly]:
    """Return the ring of H's field, and H as an element of it."""
    field, _ = canonical_field(hamiltonian)
    return field.ring, field.energy


class JetField(VectorField):
    """The field f = (−∂H/∂q, ∂H/∂p) for every H, in the jets of H."""

    def __init__(self, jets: JetsInDegrees) -> None:
        self._jets = jets
        self.names = tuple(name for name in jets.variables if name != "t")

    @classmethod
    def with_degrees(cls, degrees: int, order: int, *, separable: bool, timed: bool) -> JetField:
        """Return the field in n = `degrees` degrees of freedom, with derivatives of H up to
        `order`."""
        if degrees == 1:
            return cls.from_jets(Jets(order, separable=separable and not timed, timed=timed))
        names = numbered_names(degrees)
        return cls.from_jets(JetsInDegrees(names, order, separable=separable, timed=timed))

    @classmethod
    @lru_cache(maxsize=4)
    def from_jets(cls, jets: JetsInDegrees) -> JetField:
        """Return the field in these jets; the latest fields are cached with their derivatives."""
        return cls(jets)

    @property
    def ring(self) -> JetsInDegrees:
        """The jets."""
        return self._jets

    @cached_property
    def slopes(self) -> tuple[Poly, ...]:
        """The components −∂H/∂q and ∂H/∂p."""
        n, first = self.degrees, self._jets.first
        return (*(-first(q) for q in self.names[n:]), *map(first, self.names[:n]))

    @property
    def at_rest(self) -> Mapping[str | int, int]:
        """The values of jets at which f vanishes."""
        return {f"H_{name}": 0 for name in self.names}
