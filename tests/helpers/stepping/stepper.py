"""Steps of any map with many digits, by what they are made of: no kernel, and no closed form.

Slopes are those of sympy in gmpy2's numbers, and equations are solved by fixed-point iteration.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

import gmpy2
import sympy

from verify.arithmetic.systems import mpfr
from verify.flows.extrapolation import NumericalFlow
from verify.schemes.maps.step_map import StepMap
from verify.schemes.steps.step_algebra import StepAlgebra

DIGITS = 60
_FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh", "atan")
_MOST_ITERATIONS = 1000


class Stepper:
    """The steps of a map without symbols, in `digits` digits."""

    def __init__(self, step_map: StepMap, digits: int = DIGITS) -> None:
        self.arithmetic = mpfr.make(digits)
        self.step_map, self.field = step_map, step_map.field
        self.digits = digits
        self._numbers: dict[Any, Any] = {}

    def number(self, x: Any) -> Any:
        """A coefficient: a rational, or an element of the ring."""
        if isinstance(x, Fraction):
            return self.arithmetic.number(x)
        if id(x) not in self._numbers:
            exact = sympy.N(self.field.ring.expression(x), self.digits + 20)
            self._numbers[id(x)] = x, gmpy2.mpfr(str(exact))
        return self._numbers[id(x)][1]

    def function(self, element: Any) -> Callable[..., Any]:
        """An element of the ring, in p, q and h."""
        written = self.field.ring.expression(element)
        exact = sorted(a for a in written.atoms(sympy.Rational) if not a.is_Integer)
        named = sympy.symbols(f"r:{len(exact)}")
        at = [sympy.Symbol(n, real=True) for n in "pqh"]
        made = sympy.lambdify(
            (*at, *named), written.xreplace(dict(zip(exact, named, strict=True))),
            modules={n: getattr(gmpy2, n) for n in _FUNCTIONS},
        )  # fmt: skip
        values = [self.arithmetic.number(Fraction(int(a.p), int(a.q))) for a in exact]
        return lambda *z: made(*z, *values)

    @cached_property
    def slopes(self) -> list[Callable[..., Any]]:
        return [self.function(x) for x in self.field.slopes]

    @cached_property
    def formulas(self) -> list[Callable[..., Any]] | None:
        return self.step_map.formulas and [self.function(x) for x in self.step_map.formulas]

    def run(self, p: Fraction, q: Fraction, h: Fraction, steps: int) -> tuple[Any, Any]:
        with self.arithmetic.context():
            x, y, length = (self.arithmetic.number(v) for v in (p, q, h))
            for _ in range(steps):
                if self.formulas:
                    x, y = (f(x, y, length) for f in self.formulas)
                    continue
                assert self.step_map.step is not None
                dp, dq = self.step_map.step(_Numbers(self, (x, y), length))
                x, y = x + dp, y + dq
            return x, y

    def error(self, p: Fraction, q: Fraction, time: Fraction, steps: int) -> float:
        """How far the map's point after `time` is from the exact flow's."""
        flow = NumericalFlow(self.field, DIGITS - 15)
        exact = flow.advance((flow.number(p), flow.number(q)), flow.number(time))
        found = self.run(p, q, time / steps, steps)
        with self.arithmetic.context():
            return float(sum(abs(x - y) for x, y in zip(found, exact, strict=True)))


class _Numbers(StepAlgebra[Any]):
    """Changes of z are numbers."""

    size = 2  # type: ignore[assignment]

    def __init__(self, stepper: Stepper, z: tuple[Any, Any], h: Any) -> None:
        self.stepper, self.z, self.h = stepper, z, h

    @property
    def nothing(self) -> Any:
        return gmpy2.mpfr(0)

    def slopes(self, changes: Sequence[Any], clock: Any, places: Sequence[int]) -> list[Any]:
        p, q = (x + y for x, y in zip(self.z, changes, strict=True))
        return [self.stepper.slopes[k](p, q, self.h) for k in places]

    def move(self, change: Any, weights: Sequence[Any], slopes: Sequence[Any]) -> Any:
        pairs = zip(weights, slopes, strict=True)
        return change + self.h * sum(self.stepper.number(w) * k for w, k in pairs)

    def add_share(self, x: Any, y: Any, share: Fraction) -> Any:
        return x + self.stepper.number(share) * y

    def solve(self, count: int, right: Callable[..., list[Any]]) -> list[Any]:
        near = gmpy2.exp10(-self.stepper.digits - 3)
        values = [self.nothing] * count
        for _ in range(_MOST_ITERATIONS):
            last, values = values, right(self, values)
            if max(abs(x - y) for x, y in zip(last, values, strict=True)) < near:
                return values
        raise AssertionError("the fixed-point iteration does not converge: take a smaller h")
