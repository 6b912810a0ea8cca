"""A one-step map z ↦ z' in n degrees of freedom: its Taylor series in h, and its closed form."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Series
from verify.hamiltonians.canonical_field import CanonicalField
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.conditions import Condition
from verify.schemes.step_algebra import State, Step, series_of
from verify.schemes.step_map import AT_STAGES
from verify.schemes.substep import h_inside

SOLVABLE = "the stages have a solution that depends smoothly on z"


@dataclass(frozen=True, eq=False)
class CanonicalMap:
    """It equals itself alone.

    `step`: how z' is made, and so its series; None of a map that has a closed form alone. `closed`:
    z' in the field's ring; None where it is not written out. `conditions`: where all of them hold
    the map is symplectic, for every H that the scheme takes. `flow_up_to`: the power of h up to
    which it is made of the exact flow's own terms. `asked`: where the scheme's own formulas are
    defined. `implicit`: equations are solved for it. `expand`: z' up to h^most over a ring that
    comes with it, in place of `series`.
    """

    hamiltonian: Hamiltonian
    field: CanonicalField
    step: Step | None = None
    closed: tuple[Poly, ...] | None = None
    conditions: tuple[Condition, ...] = ()
    flow_up_to: int = -1
    asked: Domain = EVERYWHERE
    implicit: bool = False
    expand: Callable[[int], tuple[CanonicalField, State]] | None = None

    @property
    def ring(self) -> Ring:
        """The ring of all its elements."""
        return self.field.ring

    @property
    def domain(self) -> Domain:
        """Where the map is smooth: where H is, and is so at the stages, if there are any."""
        words = [SOLVABLE] if self.implicit else []
        if self.closed is None and self.hamiltonian.domain_moves:
            words.append(AT_STAGES)
        return Domain.of((), *words) & self.hamiltonian.domain & self.asked

    @cached_property
    def degree(self) -> int | None:
        """In h, of a closed form that is a polynomial in it; else None."""
        if self.closed is None or h_inside(self.ring, *self.closed):
            return None
        return max((max(self.ring.powers(x, "h"), default=0) for x in self.closed), default=0)

    def series(self, most: int) -> State | None:
        """z' up to h^most, over the field's ring; None of a closed form that is no polynomial in
        h."""
        if self.step is not None:
            return series_of(self.field, self.step, most)
        if self.degree is None or self.closed is None:
            return None
        ring, powers = self.ring, [self.ring.powers(x, "h") for x in self.closed]
        each = ([own.get(n, ring.zero) for n in range(most + 1)] for own in powers)
        return tuple(Series.of(ring, own, most) for own in each)

    @property
    def symplectic_by_conditions(self) -> bool:
        """Whether it is symplectic by what its coefficients fulfil."""
        return bool(self.conditions) and all(c.holds is True for c in self.conditions)
