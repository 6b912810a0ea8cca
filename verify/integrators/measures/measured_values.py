"""The values of a measured step, each with the noise of it, from which structures make defects.

Noise is propagated to first order, and products of two noises are added. `size` is the sum of the
absolute values of all terms: where they cancel, the rounding of floats is a part of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, TypeAlias

import gmpy2

from verify.algebra.embedding import embed
from verify.arithmetic.exact import fraction
from verify.arithmetic.systems import mpfr
from verify.flows.compiled_functions import functions_at
from verify.integrators.measures.probes import COEFFICIENT_ROUNDING, DUAL_NOISE, DualProbe, Probe
from verify.integrators.measures.reading import READING_BITS, Component, volume_change
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.wrap_periods import Periods, unwrap
from verify.integrators.tracing.dual import Comparison
from verify.integrators.user_code.step import StepError
from verify.structures import Structure
from verify.structures.volume import Volume

if TYPE_CHECKING:
    import sympy

    Real: TypeAlias = gmpy2.mpfr
# The roundings, in the numbers of the code, that are allowed in each component of a defect.
_ROUNDINGS = 32


@dataclass(frozen=True, slots=True)
class Measured:
    """A number, a bound of its noise, and the size of the terms that it is made of.

    >>> x = Measured(gmpy2.mpfr(3), 0.5, 3.0)
    >>> float((x - x * x).value), (x - x * x).noise, (x - x * x).size
    (-6.0, 3.75, 12.0)
    """

    value: Real
    noise: float
    size: float

    @classmethod
    def exact(cls, x: Fraction | int) -> Measured:
        value = gmpy2.mpfr(gmpy2.mpq(x))
        return cls(value, 0.0, abs(float(value)))

    def __add__(self, other: Measured) -> Measured:
        noise, size = self.noise + other.noise, self.size + other.size
        return Measured(self.value + other.value, noise, size)

    def __sub__(self, other: Measured) -> Measured:
        noise, size = self.noise + other.noise, self.size + other.size
        return Measured(self.value - other.value, noise, size)

    def __mul__(self, other: Measured | int) -> Measured:
        y = other if isinstance(other, Measured) else Measured.exact(other)
        noise = abs(float(self.value)) * y.noise + (abs(float(y.value)) + y.noise) * self.noise
        return Measured(self.value * y.value, noise, self.size * y.size)


# -- formulas --------------------------------------------------------------------------------------


@lru_cache(maxsize=64)
def _compile(formula: sympy.Expr, names: tuple[str, ...]) -> Callable[..., tuple[Real, ...]]:
    """Return the function from z, t and h to the formula's value and its derivatives by z."""
    variables = (*dict.fromkeys((*names, "t", "h")),)
    ring, (element,) = embed([formula], variables)
    elements = [(ring, element), *((ring, ring.diff(element, name)) for name in names)]
    return functions_at(mpfr.at_bits(READING_BITS), elements, variables)


def evaluate(
    formula: sympy.Expr,
    names: tuple[str, ...],
    z: Sequence[Fraction],
    t: Fraction,
    h: Fraction,
    reach: Sequence[float],
) -> tuple[Real, float]:
    """Return the formula's value at z, and Σ |∂/∂z_k| · reach_k. Raises StepError where it is not
    defined."""
    arithmetic = mpfr.at_bits(READING_BITS)
    try:
        with arithmetic.context():
            numbers = map(arithmetic.number, (*z, t, h))
            value, *slopes = _compile(formula, names)(*numbers)
    except (ArithmeticError, ValueError):
        raise StepError(f"{formula} is not defined there") from None
    return value, sum(abs(float(x)) * r for x, r in zip(slopes, reach, strict=True))


# -- a step ----------------------------------------------------------------------------------------


class MeasuredValues:
    """The values of one step from a place, measured when they are needed: `StepValues`.

    Raises StepError, and what the user's code raises.
    """

    def __init__(
        self,
        probe: Probe,
        place: TrialPlace,
        h: Fraction,
        periods: Periods = (),
        *,
        sharp: bool = False,
    ) -> None:
        """`periods`: of the coordinates, by which a way back is reduced; () for none. `sharp`: the
        noise of doubles is left out of dual numbers, so that only their coefficients have any."""
        self.probe, self.h, self._periods = probe, h, periods
        self.sharp = sharp and isinstance(probe, DualProbe)
        self.place = place.with_rounded_state(probe.step.numbers.round_number)
        self.comparisons: Sequence[Comparison] = ()  # of the step, once it is called
        self.names = probe.step.names

    def number(self, x: Fraction) -> Measured:
        return Measured.exact(x)

    def before(self, formula: sympy.Expr) -> Measured:
        z, zeros = self.place.z, [0.0] * len(self.names)
        value, _ = evaluate(formula, self.names, z, self.place.t, self.h, zeros)
        return Measured(value, 0.0, abs(float(value)))

    def after(self, formula: sympy.Expr) -> Measured:
        if formula.is_number:
            return self.before(formula)
        z, noise = self.end
        value, error = evaluate(formula, self.names, z, self._later(self.h), self.h, noise)
        return Measured(value, error, abs(float(value)))

    def factor(self, formula: sympy.Expr) -> Measured:
        return self.before(formula)

    @cached_property
    def end(self) -> tuple[list[Fraction], list[float]]:
        """z', and its noise."""
        if self.sharp:
            z, noise = self.probe.end(self.place, self.h), [0.0] * len(self.names)
        else:
            z, noise = self.probe.follow(self.place, self.h)
        self.comparisons = self.probe.comparisons
        return z, noise

    @cached_property
    def jacobian(self) -> list[list[Measured]]:
        if self.sharp and isinstance(self.probe, DualProbe):
            rows = self.probe.sharp_jacobian(self.place, self.h)
            errors = [[0.0] * len(row) for row in rows]
        else:
            rows, errors = self.probe.jacobian(self.place, self.h)
        self.comparisons = self.probe.comparisons
        return [
            [Measured(x, e, abs(float(x))) for x, e in zip(*row, strict=True)]
            for row in zip(rows, errors, strict=True)
        ]

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> list[Measured]:
        h, (z, noise) = -self.h if reflection is None else self.h, self.end
        if reflection:
            z, noise = self._turn(reflection, z, noise)
        # The second step begins at z' with the noise of z', and adds its own.
        place = replace(self.place, z=tuple(z), t=self._later(self.h))
        if self.sharp:
            z = self.probe.end(place, h)
        else:
            z, noise = self.probe.follow(place, h, noise)
        if reflection:
            z, noise = self._turn(reflection, z, noise)
        starts = self.place.z
        z = list(map(unwrap, z, starts, self._periods)) if self._periods else z
        with gmpy2.context(precision=READING_BITS):
            return [
                Measured(gmpy2.mpfr(gmpy2.mpq(y - x)), e, float(max(abs(x), abs(y))))
                for x, y, e in zip(starts, z, noise, strict=True)
            ]

    def _turn(
        self, reflection: Sequence[sympy.Expr], z: Sequence[Fraction], noise: Sequence[float]
    ) -> tuple[list[Fraction], list[float]]:
        """Return ρ(z), and its noise."""
        images = [evaluate(x, self.names, z, self.place.t, self.h, noise) for x in reflection]
        return [fraction(x) for x, _ in images], [e for _, e in images]

    def _later(self, h: Fraction) -> Fraction:
        return self.place.t + h if self.probe.step.time_dependent else self.place.t


@dataclass(frozen=True)
class _NaturalSizes:
    """`StepValues` whose sizes are natural ones at a place, for the scale of each component.

    A formula has its own size and that of its change over the units of the place; J is the identity
    with `mixing` of each coordinate in each other.
    """

    values: MeasuredValues
    mixing: float

    @property
    def names(self) -> tuple[str, ...]:
        return self.values.names

    def number(self, x: Fraction) -> Measured:
        return Measured.exact(x)

    def before(self, formula: sympy.Expr) -> Measured:
        place = self.values.place
        units = [float(x) for x in place.units]
        value, change = evaluate(formula, self.names, place.z, place.t, self.values.h, units)
        return Measured(value, 0.0, abs(float(value)) + change)

    after = factor = before

    @property
    def jacobian(self) -> list[list[Measured]]:
        units = [float(x) for x in self.values.place.units]
        return [
            [
                Measured(gmpy2.mpfr(0), 0.0, 1.0 if j == k else self.mixing * u / v)
                for j, v in enumerate(units)
            ]
            for k, u in enumerate(units)
        ]

    def return_by(self, reflection: Sequence[sympy.Expr] | None) -> list[Measured]:
        return [Measured(gmpy2.mpfr(0), 0.0, 2 * float(u)) for u in self.values.place.units]


def components_of(structure: Structure, values: MeasuredValues) -> dict[str, Component]:
    """Return the components of the structure's defect, with their noise and natural scales."""
    floor = _ROUNDINGS * values.probe.epsilon
    if isinstance(structure, Volume):
        return {"": _component_of_volume(structure, values, floor)}
    with gmpy2.context(precision=READING_BITS):
        defect = structure.defect(values)
        plain = structure.defect(_NaturalSizes(values, 0.0))
        if any(not x.size for x in plain.values()):
            mixed = structure.defect(_NaturalSizes(values, 1 / len(values.names)))
            plain = {name: x if x.size else mixed[name] for name, x in plain.items()}
    scales = {name: x.size / 2 for name, x in plain.items()}
    if values.sharp:
        return {
            name: Component(float(x.value), _sharp_noise(values) * scales[name], scales[name])
            for name, x in defect.items()
        }
    return {
        name: Component(float(x.value), x.noise + floor * x.size, scales[name])
        for name, x in defect.items()
    }


def _component_of_volume(structure: Volume, values: MeasuredValues, floor: float) -> Component:
    """Return ρ(z') det J − ρ(z) by elimination, which knows the noise of det J best."""
    rows, errors = ([[getattr(x, name) for x in row] for row in values.jacobian]
                    for name in ("value", "noise"))  # fmt: skip
    after, before = values.after(structure.density), values.before(structure.density)
    with gmpy2.context(precision=READING_BITS):
        change, noise = volume_change(rows, errors, values.place.units)
        value = after.value * (1 + change) - before.value
    if values.sharp:
        return Component(float(value), _sharp_noise(values) * before.size, before.size)
    noise = after.size * noise + (1 + abs(float(change))) * after.noise
    return Component(float(value), noise + floor * (before.size + after.size), before.size)


def _sharp_noise(values: MeasuredValues) -> float:
    """Return the noise of coefficients, which users write as doubles, in units of the scale."""
    return float(values.h / (values.place.step or 1)) * COEFFICIENT_ROUNDING + DUAL_NOISE
