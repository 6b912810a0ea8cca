"""Steps of a map in n degrees of freedom in ball arithmetic, with the Jacobian of each.

An oracle for kernels that shares no code with those: see `verify.exploration.degrees.ball_algebra`.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations

import flint

from verify.arithmetic.arb import Ball, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.exploration.ball_steps import BITS, sharp
from verify.exploration.degrees.ball_algebra import BallAlgebra
from verify.exploration.property import only_if
from verify.schemes.degrees.canonical_map import CanonicalMap

Matrix = flint.arb_mat


@dataclass(frozen=True)
class BallState:
    """After so many steps: the point by name (with t where H depends on it), the Jacobian of all of
    them, `matrix`, and that of the last, `own`."""

    point: dict[str, Ball]
    matrix: Matrix
    own: Matrix

    def sharp(self) -> "BallState":
        """The same; Silent where a number is too wide to be told from others."""
        only_if(all(map(sharp, [*self.point.values(), *self.matrix.entries()])))
        return self


def ball_steps(
    step: CanonicalMap, start: Mapping[str, Fraction], steps: int, bits: int = BITS
) -> Sequence[BallState]:
    """The states after 0, 1, … steps; Silent where the map solves equations, or is not defined.

    `start`: the coordinates, h, which may be negative, and t where H depends on it.
    """
    only_if(not step.implicit)
    with working_precision(bits):
        point = {name: rational_ball(x) for name, x in start.items() if name != "h"}
        one = identity(len(step.field.names))
        states = [BallState(point, one, one)]
        for _ in range(steps):
            states.append(stepped(step, states[-1], rational_ball(start["h"])))
    return states


def stepped(step: CanonicalMap, state: BallState, h: Ball) -> BallState:
    """One step from a state, in flint's present precision; Silent where it is not defined."""
    names, point = step.field.names, dict(state.point)
    algebra = BallAlgebra(step.field, point, h)
    changes = algebra.closed(step) if step.step is None else step.step(algebra)
    values = [x for change in changes for x in (change.value, *change.gradient)]
    only_if(all(x.is_finite() for x in values))
    for name, change in zip(names, changes, strict=True):
        point[name] += change.value
    if "t" in point:
        point["t"] += h
    own = Matrix([list(change.gradient) for change in changes]) + identity(len(names))
    return BallState(point, own * state.matrix, own)


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
