"""The two probes of a user's map, which measure its end z' and its Jacobian J at a place.

Dual numbers of 200 bits carry J along, with a rounding error that does not count. But users run
doubles. The noise of J is therefore the change of J if every operation is rounded to 53 bits,
however many digits the measurement has. Floats are in `verify.integrators.measures.float_probe`.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from operator import mul
from typing import TypeVar

import gmpy2

from verify.arithmetic.exact import fraction
from verify.integrators.measures.float_probe import FloatProbe
from verify.integrators.measures.reading import DefectReading, Matrix, reading_of
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.tracing.dual import DUAL_BITS, Comparison, DualNumber, Duals
from verify.integrators.tracing.function_copy import copy_function
from verify.integrators.user_code.step import StepError, Theirs, lift_numbers, limit_time
from verify.integrators.user_code.user_map import DOUBLE, UserMap

T = TypeVar("T")
_UNIT_ROUNDOFF = 2.0**-53  # of a double
# The noise of an entry of J: this number of roundings, and this multiple of the change at 53 bits.
_MIN_ROUNDINGS, _ROUNDING_FACTOR = 8, 3
_MAX_SECONDS_OF_COARSE_CALL = 2.0  # with 53 bits a loop of the code may not end
# A coefficient that is rounded to a double changes a step by this part of the distance moved.
COEFFICIENT_ROUNDING = 2.0**-52
DUAL_NOISE = 2.0 ** -(DUAL_BITS - 30)  # the noise of a value of 200 bits, relative to its size


class DualProbe:
    """The map at dual numbers: of 200 bits, and of 53 bits for the noise (`coarse`).

    `epsilon`: that of the numbers in which users run the code, which are doubles.
    """

    how = "duals"
    epsilon = 2 * _UNIT_ROUNDOFF

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

    def end(self, place: TrialPlace, h: Fraction) -> list[Fraction]:
        """Return z' as exact rationals. Raises StepError, and what the user's code raises."""
        return self._end(self.kind, place, h)

    def follow(
        self, place: TrialPlace, h: Fraction, noise: Sequence[float] | None = None
    ) -> tuple[list[Fraction], list[float]]:
        """Return z', and its noise: that of doubles, as of J, and what the noise of z makes of it.

        `noise`: that of z, None for none. Raises StepError, and what the user's code raises.
        """
        rounded_place = place.with_rounded_state(DOUBLE.round_number)
        shifts = [float(y - x) for x, y in zip(place.z, rounded_place.z, strict=True)]
        if noise is None and not any(shifts):
            end, rows = self.end(place, h), [[0.0] * len(place.z)] * len(place.z)
        else:
            duals = self._duals(self.kind, place, h)
            end = [fraction(x.value) for x in duals]
            rows = [[float(a) for a in x.slopes] or [0.0] * len(place.z) for x in duals]
        coarse = self._unless_long(lambda: self._end(self.coarse, rounded_place, h)) or end
        errors = []
        for x, y, c, row in zip(place.z, end, coarse, rows, strict=True):
            # Where the state was rounded for the coarse call, its end moves as J says.
            change = 0.0 if coarse is end else float(c - y) - sum(map(mul, row, shifts))
            error = _MIN_ROUNDINGS * _UNIT_ROUNDOFF * float(abs(y) + abs(y - x))
            carried = sum(abs(a) * e for a, e in zip(row, noise or (), strict=False))
            errors.append(error + _ROUNDING_FACTOR * abs(change) + carried)
        return end, errors

    def _end(self, kind: Duals, place: TrialPlace, h: Fraction) -> list[Fraction]:
        return [fraction(x.value) for x in self._duals(kind, place, h, gmpy2.mpfr(1))]

    def round_number(self, x: Fraction) -> Fraction:
        """Return x unchanged: dual numbers have enough digits."""
        return x

    def noise(self, place: TrialPlace, state: Sequence[Fraction]) -> list[float]:
        """Return the noise of z' that the rounding of dual numbers causes."""
        return [DUAL_NOISE * float(max(abs(x), abs(y)) + u)
                for x, y, u in zip(state, place.z, place.units, strict=True)]  # fmt: skip

    def reading(self, place: TrialPlace, h: Fraction) -> DefectReading:
        """Measure S and det J − 1. Raises StepError, and what the user's code raises."""
        return reading_of(place, h, *self.jacobian(place, h), self.epsilon)

    def jacobian(self, place: TrialPlace, h: Fraction) -> tuple[Matrix, list[list[float]]]:
        """Return J, and the noise of its entries. Raises StepError, and what the code raises."""
        fine = self.sharp_jacobian(place, h)
        comparisons = self.kind.comparisons
        errors = [[_MIN_ROUNDINGS * _UNIT_ROUNDOFF * abs(float(x)) for x in row] for row in fine]
        self._add_rounding(errors, fine, place, h)
        self.kind.comparisons = comparisons
        return fine, errors

    def _add_rounding(
        self, errors: list[list[float]], fine: Matrix, place: TrialPlace, h: Fraction
    ) -> None:
        """Add to each row the change of J at 53 bits; a row has one noise, in units of the place.

        The place is rounded to doubles for this.
        """
        rounded_place = place.with_rounded_state(DOUBLE.round_number)
        coarse = self._unless_long(lambda: self.sharp_jacobian(rounded_place, h, self.coarse))
        if coarse is None:  # the errors stay at their minimum
            return
        # Both precisions must be compared at the same state: where rounding moves it, the fine
        # Jacobian is computed again.
        if rounded_place.z != place.z:
            fine = self.sharp_jacobian(rounded_place, h)
        units = [float(x) for x in place.units]
        for row, one, two in zip(errors, coarse, fine, strict=True):
            gaps = [abs(float(x) - float(y)) * u for x, y, u in zip(one, two, units, strict=True)]
            largest = _ROUNDING_FACTOR * max(gaps)
            for j, unit in enumerate(units):
                row[j] += largest / unit

    def _unless_long(self, call: Callable[[], T]) -> T | None:
        """Return the result of a call with 53 bits; None if it fails, or takes too long."""
        try:
            with limit_time(_MAX_SECONDS_OF_COARSE_CALL, "rounded to doubles it does not end"):
                return call()
        except Exception:  # the user's code may raise anything
            return None

    def sharp_jacobian(self, place: TrialPlace, h: Fraction, kind: Duals | None = None) -> Matrix:
        """Return J alone, as dual numbers have it, those of 200 bits or of this kind."""
        zeros = (gmpy2.mpfr(0),) * len(place.z)
        return [x.slopes or zeros for x in self._duals(kind or self.kind, place, h)]

    def _duals(
        self, kind: Duals, place: TrialPlace, h: Fraction, *slope: "gmpy2.mpfr"
    ) -> list[DualNumber]:
        """Return z' with its derivatives by z; `slope`: that of each z along one direction, in
        place of all."""
        kind.comparisons = []
        with kind.running():
            state = kind.state(*place.z)
            state = [DualNumber(kind, x.value, slope) for x in state] if slope else state
            size, clock = kind.rational(h), kind.rational(place.t)
            function = self._functions[kind.bits]
            result: list[Theirs] = self.step.call(function, state, size, clock, kind.rational)
            end: list[DualNumber] = lift_numbers(state[0], result)
            if not all(gmpy2.is_finite(x.value) for x in end):
                raise StepError("it returns what is not finite")
        return end


Probe = DualProbe | FloatProbe


def probe_of(step: UserMap, how: str) -> Probe:
    """Build the probe called "duals", or else the one called "floats"."""
    return DualProbe(step) if how == "duals" else FloatProbe(step)
