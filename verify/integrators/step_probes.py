"""A user's step and its Jacobian at a point: by dual numbers, or by differences of floats."""

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from verify.arithmetic.exact import fraction
from verify.arithmetic.systems import mpfr
from verify.integrators.step import Step, Theirs, lifted
from verify.integrators.tracing.dual import BITS, Duals
from verify.integrators.tracing.functions import copied
from verify.integrators.wrapped import unwrapped

if TYPE_CHECKING:
    import gmpy2

Point = tuple[Fraction, Fraction]  # p, q
End: TypeAlias = "tuple[gmpy2.mpfr, gmpy2.mpfr]"  # p', q'
MORE = 3  # digits of the exact flow than a number has that a step computes in
_DUAL_NOISE = 2.0 ** -(BITS - 30)
_STENCIL = ((-3, -1), (-2, 9), (-1, -45), (1, 45), (2, -9), (3, 1))  # of order 6, over 60


class _Duals:
    """The step at dual numbers."""

    def __init__(self, step: Step) -> None:
        self.step, self.kind = step, Duals()
        with self.kind.running():
            self.function = copied(step.function, self.kind)

    @property
    def opaque(self) -> bool:
        return self.kind.compared

    @property
    def rounded(self) -> bool:
        return bool(self.kind.rounded)

    def end(self, point: Point, h: Fraction) -> tuple[End, float]:
        """The state after one step, and its noise."""
        state, _, _, noise = self.at(point, h)
        return state, noise

    def at(self, point: Point, h: Fraction) -> tuple[End, float, float, float]:
        """The same, with ΔJ and its noise between them."""
        with self.kind.running():
            p, q = self.kind.state(*point)
            size, clock = map(self.kind.rational, (h, self.step.clock(*point)))
            x, y = dual_step(self.step, self.function, p, q, size, clock)
            delta = x.by_p * y.by_q - x.by_q * y.by_p - 1
            terms = abs(x.by_p * y.by_q) + abs(x.by_q * y.by_p) + 1
            reach = 1 + abs(x.value) + abs(y.value)
            return (
                (x.value, y.value),
                float(delta),
                _DUAL_NOISE * float(terms),
                _DUAL_NOISE * float(reach),
            )


def dual_step(
    step: Step,
    function: Callable[..., Theirs],
    p: Theirs,
    q: Theirs,
    h: Theirs,
    t: Theirs = 0.0,
) -> Theirs:
    """p' and q' of a copied function at numbers of ours."""
    with step.limited():
        result = step.called(function, p, q, h, t)
    return lifted(p, step.pair(result))


class _Floats:
    """The step at floats, or at numbers of another type; what is made of them is exact."""

    opaque = rounded = True

    def __init__(self, step: Step) -> None:
        self.step = step

    def end(self, point: Point, h: Fraction) -> tuple[End, float]:
        """The state after one step, and its noise: one call."""
        (p, q), size = self._rounded(point, h)
        (here,) = self.step.exactly([(p, q)], *size)
        number = mpfr.make(self.step.numbers.digits + MORE).number
        reach = 1 + max(float(abs(x)) for x in (*here, p, q))
        return (number(here[0]), number(here[1])), 4 * self.step.numbers.epsilon * reach

    def at(self, point: Point, h: Fraction) -> tuple[End, float, float, float]:
        """The same, with ΔJ and its noise between them: 25 calls."""
        state, noise = self.end(point, h)
        (p, q), size = self._rounded(point, h)
        width = Fraction(self.step.numbers.width * float(1 + max(abs(p), abs(q))))
        one, two = (self._determinant((p, q), size, w) for w in (width, width / 2))
        # The wider stencil's error is 2⁶ times the narrower's, whose rounding is twice as large.
        delta_noise = float(abs(one - two)) + 2 * noise / float(width)
        return state, float(two), delta_noise, noise

    def _rounded(self, point: Point, h: Fraction) -> tuple[Point, tuple[Fraction, Fraction]]:
        """The point, and h and t there, in numbers of the step's type."""
        rounded = self.step.rounded
        return (rounded(point[0]), rounded(point[1])), (
            rounded(h),
            rounded(self.step.clock(*point)),
        )

    def _determinant(self, z: Point, size: tuple[Fraction, Fraction], width: Fraction) -> Fraction:
        """ΔJ by central differences of the increments, with h and t as they are."""
        from gmpy2 import mpq  # whose sums are ten times as fast

        moves = [(i, k, weight) for i in (0, 1) for k, weight in _STENCIL]
        points = []
        for i, k, _ in moves:
            moved = self.step.rounded(z[i] + k * width)
            points.append((moved, z[1]) if i == 0 else (z[0], moved))
        totals, ends = [[mpq(0)] * 2, [mpq(0)] * 2], self.step.exactly(points, *size)
        for each in ends[1:] if self.step.periods else ():  # all on one side of where it wraps
            each[:] = map(unwrapped, each, ends[0], self.step.periods)
        for (i, _, weight), x, y in zip(moves, points, ends, strict=True):
            for j in (0, 1):
                totals[i][j] += weight * (mpq(y[j]) - mpq(x[j]))
        (u_p, v_p), (u_q, v_q) = ([x / mpq(60 * width) for x in total] for total in totals)
        return fraction(u_p + v_q + u_p * v_q - u_q * v_p)


Probe = _Duals | _Floats
PROBES: dict[str, type[Probe]] = {"duals": _Duals, "floats": _Floats}
