"""Steps of a map in ball arithmetic, with the Jacobian of each.

No kernel is written for them: an oracle for the number systems that shares no code with those, and
rigorous. ΔJ is taken from the entries of J, not from its closed form.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

import flint

from verify.arithmetic.arb import Ball, rational_ball, shown
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.property import Silent, Violation, known, only_if
from verify.schemes.maps.ball_algebra import UndefinedError, step_in_balls
from verify.schemes.maps.step_map import StepMap

BITS = 320
_SHARP = 120  # bits that a ball must know to be worth comparing
Matrix = flint.arb_mat
Point = dict[str, Ball]


@dataclass(frozen=True)
class BallState:
    """After so many steps: the point by name (with t where H depends on it), the Jacobian of all of
    them, `matrix`, that of the last, `own`, and Π det J_k over them."""

    point: Point
    matrix: Matrix
    own: Matrix
    product: Ball

    def sharp(self) -> "BallState":
        """The same; Silent where a number is too wide to be told from others.

        In the plane the product stands for the Jacobian, whose entries may be wide where it is not.
        """
        planar = self.matrix.nrows() == 2
        only_if(all(map(sharp, self.point.values())))
        only_if(all(map(sharp, [self.product] if planar else self.matrix.entries())))
        return self


def ball_steps(
    step: StepMap, start: Mapping[str, Fraction], steps: int, bits: int = BITS
) -> Sequence[BallState]:
    """The states after 0, 1, … steps; Silent where the map solves equations, or is not defined.

    `start`: the coordinates, h, which may be negative, and t where H depends on it.
    """
    only_if(not step.implicit)
    with working_precision(bits):
        point = {name: rational_ball(x) for name, x in start.items() if name != "h"}
        one = identity(len(step.hamiltonian.coordinates))
        states = [BallState(point, one, one, flint.arb(1))]
        for _ in range(steps):
            states.append(stepped(step, states[-1], rational_ball(start["h"])))
    return states


def stepped(step: StepMap, state: BallState, h: Ball) -> BallState:
    """One step from a state, in flint's present precision; Silent where it is not defined."""
    point, written = dict(state.point), step.closed if step.formulas is not None else None
    try:
        changes, slopes = step_in_balls(step.field, written or known(step.step), point, h)
    except UndefinedError:
        raise Silent from None
    for name, change in zip(step.field.names, changes, strict=True):
        point[name] += change
    own = slopes + identity(len(changes))
    if "t" in point:
        point["t"] += h
    return BallState(point, own * state.matrix, own, state.product * own.det())


def identity(size: int) -> Matrix:
    """The matrix 1."""
    return Matrix([[int(a == b) for b in range(size)] for a in range(size)])


def omega(size: int) -> Matrix:
    """Ω of Σ dp_i∧dq_i, of z = (p1 … pn, q1 … qn)."""
    n = size // 2
    return Matrix([[(b == a + n) - (a == b + n) for b in range(size)] for a in range(size)])


def defect(jacobian: Matrix) -> Matrix:
    """JᵀΩJ − Ω, in flint's present precision."""
    canonical = omega(jacobian.nrows())
    return jacobian.transpose() * canonical * jacobian - canonical


def entries(form: Matrix) -> Iterator[Ball]:
    """Those of an antisymmetric matrix above its diagonal."""
    for a, b in combinations(range(form.nrows()), 2):
        yield form[a, b]


def largest(form: Matrix) -> Ball:
    """The greatest |entry|."""
    found = flint.arb(0)
    for x in entries(form):
        found = found.max(abs(x))
    return found


def overlap(x: Matrix, y: Matrix) -> bool:
    """Whether two matrices may be the same."""
    return all(a.overlaps(b) for a, b in zip(x.entries(), y.entries(), strict=True))


def unlike(found: Ball, wanted: Ball) -> str:
    """`found` and what it should be, with their difference, which 12 digits may not show."""
    with working_precision(BITS):
        difference = found - wanted
    given = f"{shown(found, 12)}, and should be {shown(wanted, 12)}"
    return f"{given} (too large by {shown(difference, 3)})"


def must_overlap(what: str, found: Ball, wanted: Ball, how: str = "") -> None:
    """Violation where the two are apart: `what` with its verb, what it should be, and `how` that is
    known."""
    if not found.overlaps(wanted):
        raise Violation(f"{what} {unlike(found, wanted)}{how}")


def sharp(x: Ball) -> bool:
    """Whether a ball is narrow: relative to numbers beyond 1, and absolute below."""
    return bool(x.is_finite()) and x.rad() * 2**_SHARP < 1 + x.abs_lower()
