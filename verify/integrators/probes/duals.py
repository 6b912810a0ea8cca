"""A user's map at dual numbers of 200 bits, and, for the noise of his doubles, of 53 bits.

What users run is double: what a rounding of every operation to 53 bits does to J at a place is the
noise that J has there, however many digits it is measured with.
"""

from collections.abc import Sequence
from fractions import Fraction

import gmpy2

from verify.arithmetic.exact import fraction
from verify.integrators.places.place import Place
from verify.integrators.probes.reading import Matrix, Reading, reading_of
from verify.integrators.tracing.dual import BITS, Comparison, Dual, Duals
from verify.integrators.tracing.functions import copy_function
from verify.integrators.user_code.number_type import DOUBLE
from verify.integrators.user_code.step import StepError, Theirs, lift_numbers, limit_time
from verify.integrators.user_code.user_map import UserMap

_EPSILON = 2.0**-53  # half a unit of a double's last place
_ROUNDINGS, _SPREAD = 8, 3  # of each entry at least; and times what is seen of them
_SECONDS = 2.0  # for a call with 53 bits, whose loops may not end
OWN_NOISE = 2.0 ** -(BITS - 30)  # of a value of 200 bits, in parts of its size


class DualProbe:
    """The map at dual numbers. `comparisons`: those of the last call."""

    how = "duals"

    def __init__(self, step: UserMap) -> None:
        self.step, self.kind, self.coarse = step, Duals(), Duals(53)
        self._functions = {}
        for kind in (self.kind, self.coarse):
            with kind.running():
                self._functions[kind.bits] = copy_function(step.function, kind)

    @property
    def opaque(self) -> bool:
        """True if numbers were compared, so that there may be branches or a tolerance."""
        return self.kind.compared

    @property
    def comparisons(self) -> Sequence[Comparison]:
        """The comparisons of the last call."""
        return self.kind.comparisons

    def end(self, place: Place, h: Fraction) -> list[Fraction]:
        """Return z' as exact rationals. Raises StepError, and what the user's code raises."""
        with self.kind.running():
            one = (gmpy2.mpfr(1),)
            state = [Dual(self.kind, self.kind.rational(x).value, one) for x in place.z]
            ended = self._call(self.kind, state, place, h)
            return [fraction(x.value) for x in ended]

    def round_number(self, x: Fraction) -> Fraction:
        """Return x as it stands: dual numbers have digits enough."""
        return x

    def noise(self, place: Place, state: Sequence[Fraction]) -> list[float]:
        """Return the noise of z' that our own numbers have."""
        return [OWN_NOISE * float(max(abs(x), abs(y)) + u)
                for x, y, u in zip(state, place.z, place.units, strict=True)]  # fmt: skip

    def reading(self, place: Place, h: Fraction) -> Reading:
        """Measure S and det J − 1. Raises StepError, and what the user's code raises."""
        fine = self._jacobian(self.kind, place, h)
        comparisons = self.kind.comparisons
        errors = [[_ROUNDINGS * _EPSILON * abs(float(x)) for x in row] for row in fine]
        self._add_rounding(errors, fine, place, h)
        self.kind.comparisons = comparisons
        return reading_of(place, h, fine, errors, 2 * _EPSILON)

    def _add_rounding(
        self, errors: list[list[float]], fine: Matrix, place: Place, h: Fraction
    ) -> None:
        """Add the noise that 53 bits cause in each row, at a place that has no more, in units of
        the columns."""
        rounded_place = place.with_rounded_state(DOUBLE.round_number)
        try:
            with limit_time(_SECONDS, "rounded to doubles it does not end"):
                coarse = self._jacobian(self.coarse, rounded_place, h)
        except Exception:  # the user's code may raise anything; then its least noise has to do
            return
        # Both precisions must be compared at the same state: where rounding moves it, the fine
        # Jacobian is computed again.
        same = fine if rounded_place.z == place.z else self._jacobian(self.kind, rounded_place, h)
        units = [float(x) for x in place.units]
        for row, one, two in zip(errors, coarse, same, strict=True):
            gaps = [abs(float(x) - float(y)) * u for x, y, u in zip(one, two, units, strict=True)]
            largest = _SPREAD * max(gaps)
            for j, unit in enumerate(units):
                row[j] += largest / unit

    def _jacobian(self, kind: Duals, place: Place, h: Fraction) -> Matrix:
        with kind.running():
            end = self._call(kind, kind.state(*place.z), place, h)
            zeros = (gmpy2.mpfr(0),) * len(place.z)
            return [x.slopes or zeros for x in end]

    def _call(self, kind: Duals, state: list[Dual], place: Place, h: Fraction) -> list[Dual]:
        kind.comparisons = []
        step, size, clock = self.step, kind.rational(h), kind.rational(place.t)
        result: list[Theirs] = step.call(
            self._functions[kind.bits], state, size, clock, kind.rational
        )
        end: list[Dual] = lift_numbers(state[0], result)
        if not all(gmpy2.is_finite(x.value) for x in end):
            raise StepError("it returns what is not finite")
        return end
