"""A one-step map z ↦ z' in n degrees of freedom: its Taylor series in h, and its closed form."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from verify.algebra.conditions import Condition
from verify.algebra.domain import EVERYWHERE, Domain
from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Series, at_moved
from verify.hamiltonians.canonical_field import CanonicalField, Flow
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.step_map import AT_STAGES
from verify.schemes.substep import h_inside

SOLVABLE = "the stages have a solution that depends smoothly on z"
State = tuple[Series, ...]  # a series for each of p1 … pn, q1 … qn


@dataclass(frozen=True, eq=False)
class CanonicalMap:
    """It equals itself alone.

    `series(most)`: z' up to h^most, over the field's ring; None of a closed form that is no
    polynomial in h. `closed`: z' in that ring; None where it is not written out. `conditions`:
    where all of them hold the map is symplectic, for every H that the scheme takes. `flow_up_to`:
    the power of h up to which it is made of the exact flow's own terms. `asked`: where the scheme's
    own formulas are defined. `implicit`: equations are solved for it. `expand`: z' up
    to h^most over a ring that comes with it, in place of `series`.
    """

    hamiltonian: Hamiltonian
    field: CanonicalField
    series: Callable[[int], State] | None
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
        if self.closed is None and self.hamiltonian.domain.names & {*self.field.names}:
            words.append(AT_STAGES)
        return Domain.of((), *words) & self.hamiltonian.domain & self.asked

    @cached_property
    def degree(self) -> int | None:
        """In h, of a closed form that is a polynomial in it; else None."""
        if self.closed is None or h_inside(self.ring, *self.closed):
            return None
        return max((max(self.ring.powers(x, "h"), default=0) for x in self.closed), default=0)

    @property
    def symplectic_by_conditions(self) -> bool:
        """Whether it is symplectic by what its coefficients fulfil."""
        return bool(self.conditions) and all(c.holds is True for c in self.conditions)


def start_of(field: Flow, most: int) -> State:
    """z as series."""
    return tuple(Series.of(field.ring, [x], most) for x in field.start)


def slopes_at(
    field: Flow, changes: Sequence[Series], clock: Series | None, places: Sequence[int]
) -> list[Series]:
    """Those components of f at z + changes, and where H depends on it at t + clock."""
    ring, most = field.ring, changes[0].most
    moves = [move for move in zip(field.names, changes, strict=True) if not move[1].vanishes]
    if field.timed and clock is not None and not clock.vanishes:
        moves.append(("t", clock))
    return [at_moved(ring, field.slopes[k], moves, most) for k in places]
