"""A function I(z), or I(z, t), whose change along a run is asked for: H, or a formula."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache

import flint

from verify.algebra.embedding import embed
from verify.algebra.enclosure import Enclosures
from verify.algebra.formula import parse
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.observables.observable import ENERGY

Ball = flint.arb
_ATTEMPTS = 6  # the precision doubles from one to the next


@dataclass(frozen=True, eq=False)
class Integral:
    """The function, an element of a ring; `names` are the coordinates."""

    ring: Ring
    element: Poly
    names: tuple[str, ...]

    @property
    def depends_on_time(self) -> bool:
        """True if it depends on t."""
        return "t" in self.ring.variables and self.ring.depends(self.element, "t")

    @cached_property
    def _values(self) -> Enclosures:
        return Enclosures(self.ring, [self.element])

    @cached_property
    def _slopes(self) -> Enclosures:
        gradient = [self.ring.diff(self.element, name) for name in self.names]
        return Enclosures(self.ring, gradient)

    def enclose(self, box: Mapping[str, Ball]) -> Ball | None:
        """Return a ball that contains I over a box; None if I may be undefined in it."""
        values = self._values.enclose_over(box)
        return values[0] if values else None

    def slopes(self, box: Mapping[str, Ball]) -> list[Ball] | None:
        """Return balls that contain ∂I/∂z over a box; None if one may be undefined in it."""
        return self._slopes.enclose_over(box)

    def evaluate(self, point: Mapping[str, Fraction], bits: int) -> Ball | None:
        """Return a ball that contains I at a point, with a radius of at most 2^−bits (1 + |I|);
        None if I is not defined there."""
        precision = bits + 32
        for _ in range(_ATTEMPTS):
            with working_precision(precision):
                value = self.enclose({name: rational_ball(x) for name, x in point.items()})
                limit = flint.arb(2) ** -bits
                if value is not None and value.rad() <= limit * (1 + value.abs_lower()):
                    return value
            precision *= 2
        return None


@lru_cache(maxsize=64)
def integral_of(hamiltonian: Hamiltonian, formula: str) -> Integral:
    """Return H itself for ENERGY, or the function of a formula in the system's coordinates.

    Raises InputError for a bad formula, and for one in other names.
    """
    names = hamiltonian.coordinates
    if formula == ENERGY:
        field, _ = canonical_field(hamiltonian)
        return Integral(field.ring, field.energy, names)
    variables = (*names, *(("t",) if hamiltonian.time_dependent else ()))
    ring, (element,) = embed([parse(formula, variables, source="integral")], variables)
    return Integral(ring, element, names)
