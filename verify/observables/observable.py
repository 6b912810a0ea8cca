"""An observable of a run: all that other rooms need of it, in one object.

Its effect on the loop of a kernel, on the certificate of a run, and on a map is written against the
protocols below: nothing that steps is imported.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal, Protocol, TypeAlias

Ball: TypeAlias = Any  # an arb
# Of a step: ΔJ; the determinant of J's four entries; the entries of S; M and W; M alone.
Need: TypeAlias = Literal["delta_j", "determinant", "symplectic", "carried", "matrix"]
ENERGY = "H"  # the name of H among the functions whose change along a run is asked for


class Loop(Protocol):
    """The writer of a kernel's loop: see `verify.kernels.statements`."""

    @property
    def value(self) -> Mapping[str, str]:
        """The names of a step's values: `dj`, `det`, the increments of M and of W."""

    @property
    def entries(self) -> Sequence[str]:
        """The names of the entries of S."""

    def carry(self, name: str, start: int, kind: str = "wide") -> None:
        """Add a number that is carried from step to step: its name and the value it begins with."""

    def sum_up(self, name: str, increment: str) -> list[str]:
        """Return the statements of a sum that begins with 0."""

    def accumulate(self, name: str, increment: str) -> list[str]:
        """Return the statements that add to a carried number."""

    def product(self) -> list[str]:
        """Return the statements of Λ, once."""

    def matrix(self) -> list[str]:
        """Return the statements of M, once."""

    def largest(self, name: str, term: str, kind: str = "wide") -> list[str]:
        """Return the statements that keep the greatest |term|."""

    def extremes(self, integral: str) -> list[str]:
        """Return the statements that keep the least and the greatest value of a function."""


class Certificate(Protocol):
    """The bounds on a run when its errors are certified: see `verify.runs.a_posteriori_bound`.

    `error`: a bound of ‖e_k‖ for all k. `steps`: how many there are. `scale`: 2^−s. `rounded`: the
    rounding of one step. `slope`, `size`: bounds of the gradient of 2^s ΔJ and of itself;
    `sum_of_shifts`: of the sum of its errors. `total(name)`: a value as it was computed. `adding`:
    the rounding of a term and of its addition to a sum of squares.
    """

    error: Ball
    steps: int
    scale: Ball
    rounded: Any

    @property
    def slope(self) -> Ball: ...
    @property
    def size(self) -> Ball: ...
    @property
    def sum_of_shifts(self) -> Ball: ...

    def total(self, name: str) -> Ball: ...
    def adding(self, total: Ball, term: Ball) -> Ball: ...
    def bound_of_product(self) -> Ball: ...
    def slope_of_form(self) -> Ball: ...
    def bound_of_form(self) -> Ball | None: ...
    def bound_of_change(self, integral: str) -> Ball | None: ...
    def bound_of_greatest_change(self, integral: str) -> Ball | None: ...
    def bound_of_defect(self, name: str) -> Ball | None: ...


class Map(Protocol):
    """The properties of a one-step map that a proof decides."""

    @property
    def preserves_area(self) -> bool: ...
    @property
    def conserves_energy(self) -> bool: ...


def has_no_defect(step: Map) -> bool:
    """Return True if every quantity made of S, or of ΔJ, alone vanishes."""
    return step.preserves_area


def never(_: Map) -> bool:
    """Return False: of a quantity computed for its rounding a proof says nothing."""
    return False


@dataclass(frozen=True)
class Observable:
    """An observable: `name` in scenes, in Python's arguments, in JSON; `label` and `tex` on pages.

    - `order`: its place among the others. `usual`: its place among those that are computed
      by default; None if it is not.
    - `needs`: the quantity of a step that it is made of; None if it is made of the state alone.
      `lines`: its statements in a loop.
    - `integral`: the function of the state of whose change along the run it is made: ENERGY or a
      formula; "" for other observables. `at_end`: of the change from the start to the end alone.
      `aside`: it is computed by default where it is for the system, with the digits that it has.
    - `structure`: the structure whose accumulated defect it is, as a text; "" for others.
    - `carried`: the accumulator that it is read from, or the prefix of the names of several;
      `shift`: so many times 2^s it carries there; `begins`: its start value, which is subtracted.
      `read`: its value, from the carried numbers after so many steps.
    - `vanishes`: True if it is 0 after every step of a map, by a proof.
    - `constant`: its value where ΔJ is the same number at every step, if that is known then.
    - `bound`: of its error, by a certificate, if there is one; None: it has none.
    - `growth`: the power of N by which that bound grows if the tangent map grows linearly.
    - `most_degrees`: of freedom, 1 for the plane alone; a step's operations bound it.
      `in_plane`: the observable that is the same in the plane, and is used there in its place.
      `timed`: whether there is one of an H that depends on t.
    - `heading`: over a column of a page; `plotted`: at an axis; `short`: on a terminal. If one
      is empty it is `label`.
    """

    name: str
    label: str
    tex: str
    order: int
    needs: Need | None
    lines: Callable[[Loop], list[str]]
    carried: str
    integral: str = ""
    at_end: bool = False
    aside: bool = False
    structure: str = ""
    usual: int | None = None
    shift: int = 0
    begins: int = 0
    read: Callable[[Sequence[Fraction], int], Fraction] = lambda totals, steps: totals[0]
    vanishes: Callable[[Map], bool] = has_no_defect
    constant: Callable[[Ball, int], Ball | None] | None = None
    bound: Callable[[Certificate], Ball | None] | None = None
    growth: int = 3
    most_degrees: int | None = None
    in_plane: str = ""
    timed: bool = True
    heading: str = ""
    plotted: str = ""
    short: str = ""

    def fits(self, degrees: int) -> bool:
        """Return True if it is available in so many degrees of freedom."""
        return self.most_degrees is None or degrees <= self.most_degrees

    @property
    def of_any_field(self) -> bool:
        """True if it is also of equations without an H: of ΔJ, or of a formula of one's own."""
        return self.needs in (None, "delta_j", "matrix") and self.integral != ENERGY

    @property
    def of_one_run(self) -> bool:
        """True if one run of N steps gives it."""
        return bool(self.carried or self.integral)

    @property
    def is_signed(self) -> bool:
        """True if it may be negative: its absolute value is plotted then."""
        return bool(self.plotted)
