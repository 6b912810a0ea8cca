"""The probe of a user's map by floats, or numbers of another type, as its users call it.

It yields J by extrapolated central differences. The widths of the differences begin at that over
which the motion changes, and are halved. Of the values of Richardson extrapolation (Ridders, Adv.
Eng. Softw. 4 (1982)) that with the least error is taken, as estimated from the neighbours in the
extrapolation table and the rounding of the numbers. The differences themselves are computed without
rounding.
"""

from collections.abc import Sequence
from fractions import Fraction

import gmpy2

from verify.integrators.measures.reading import READING_BITS, DefectReading, Matrix, reading_of
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.places.wrap_periods import unwrap
from verify.integrators.tracing.dual import Comparison
from verify.integrators.user_code.step import StepError
from verify.integrators.user_code.user_map import UserMap

_MIN_HALVINGS = 8  # of the width of a difference
_SCATTER_STATES = 8  # states a tiny distance apart, from which the scatter of z' is measured
_SCATTER_FACTOR = 2.0  # the noise is this multiple of the measured scatter


class FloatProbe:
    """The map at numbers as its users call it."""

    how = "floats"
    comparisons: Sequence[Comparison] = ()

    def __init__(self, step: UserMap) -> None:
        self.step = step
        self._scatter: dict[tuple[TrialPlace, Fraction], list[float]] = {}

    def round_number(self, x: Fraction) -> Fraction:
        """Round x to the type of number that the step is called with."""
        return self.step.numbers.round_number(x)

    def end(self, place: TrialPlace, h: Fraction) -> list[Fraction]:
        """Return z' as exact rationals. Raises StepError, and what the user's code raises."""
        (ended,) = self._ends([place.with_rounded_state(self.round_number).z], place, h)
        return ended

    def noise(self, place: TrialPlace, state: Sequence[Fraction]) -> list[float]:
        """Return the least noise of z': one unit of the last place of each component."""
        epsilon = self.step.numbers.epsilon
        return [epsilon * float(max(abs(x), abs(y)))
                for x, y in zip(state, place.z, strict=True)]  # fmt: skip

    def scatter(self, place: TrialPlace, h: Fraction) -> list[float]:
        """Return the measured noise of z': the scatter of each component about a smooth curve."""
        key = place, h
        if key not in self._scatter:
            self._scatter[key] = self._measure_scatter(place, h)
        return self._scatter[key]

    def _measure_scatter(self, place: TrialPlace, h: Fraction) -> list[float]:
        z, epsilon = place.with_rounded_state(self.round_number).z, self.step.numbers.epsilon
        # Over so small a distance the curvature of a smooth map is below the rounding.
        tiny = Fraction(1, 2 ** (2 * self.step.numbers.bits // 5))
        states = [
            [self.round_number(x + k * tiny * u) for x, u in zip(z, place.reach, strict=True)]
            for k in range(_SCATTER_STATES)
        ]
        ends = self._ends(states, place, h)
        noises = []
        for i in range(len(z)):
            values = [end[i] for end in ends]
            # Third differences of a smooth curve vanish at such a distance.
            thirds = [
                float(abs(d - 3 * c + 3 * b - a))
                for a, b, c, d in zip(values, values[1:], values[2:], values[3:], strict=False)
            ]
            smallest_noise = epsilon * float(max(abs(ends[0][i]), abs(z[i])))
            jump = self.step.coarseness * max(float(place.units[i]), abs(float(ends[0][i])))
            noises.append(smallest_noise + _SCATTER_FACTOR * max(thirds) / 8 + jump)
        return noises

    def follow(
        self, place: TrialPlace, h: Fraction, noise: Sequence[float] | None = None
    ) -> tuple[list[Fraction], list[float]]:
        """Return z', and its noise: its scatter, and what the noise of z makes of it.

        `noise`: that of z, None for none. Raises StepError, and what the user's code raises.
        """
        z, scatter = place.with_rounded_state(self.round_number).z, self.scatter(place, h)
        if noise is None:
            return self.end(place, h), scatter
        widths = [x / 2 ** (self.step.numbers.bits // 3) for x in place.reach]
        states = [list(z) for _ in range(len(z) + 1)]
        for j, width in enumerate(widths):
            states[j + 1][j] = self.round_number(z[j] + width)
        first, *ends = self._ends(states, place, h)
        ratios = [e / float(w) for e, w in zip(noise, widths, strict=True)]
        carried = [
            sum(float(abs(end[k] - x)) * r for end, r in zip(ends, ratios, strict=True))
            for k, x in enumerate(first)
        ]
        return first, [a + b for a, b in zip(scatter, carried, strict=True)]

    def reading(self, place: TrialPlace, h: Fraction) -> DefectReading:
        """Measure S and det J − 1. Raises StepError, and what the user's code raises."""
        return reading_of(place, h, *self.jacobian(place, h), self.epsilon)

    @property
    def epsilon(self) -> float:
        """The distance between 1 and the next number of the code."""
        return self.step.numbers.epsilon

    def jacobian(self, place: TrialPlace, h: Fraction) -> tuple[Matrix, list[list[float]]]:
        """Return J, and the noise of its entries. Raises StepError, and what the code raises."""
        z, scatter = place.with_rounded_state(self.round_number).z, self.scatter(place, h)
        columns, blurs = [], []
        with gmpy2.context(precision=READING_BITS):
            for j in range(len(z)):
                column, blur = self._column(place, h, z, j, scatter)
                columns.append(column)
                blurs.append(blur)
        rows = [list(row) for row in zip(*columns, strict=True)]
        errors = [list(row) for row in zip(*blurs, strict=True)]
        least_error = 4 * self.epsilon
        for row, error in zip(rows, errors, strict=True):
            for k, x in enumerate(row):
                error[k] += least_error * abs(float(x))
        return rows, errors

    def _column(
        self, place: TrialPlace, h: Fraction, z: Sequence[Fraction], j: int, scatter: list[float]
    ) -> tuple[list["gmpy2.mpfr"], list[float]]:
        """Return ∂z'/∂z_j, and the errors of its entries."""
        levels = max(_MIN_HALVINGS, self.step.numbers.bits // 8)
        widths = [place.reach[j] / 2**k for k in range(1, levels + 1)]
        tiny = place.reach[j] / 2 ** (self.step.numbers.bits // 3)
        # Two tiny widths stand beside those that are extrapolated: they stay on one side of a jump,
        # at the price of more noise.
        widths += [2 * tiny, tiny]
        states, steps = [], []
        for width in widths:
            pair = [list(z), list(z)]
            for state, sign in zip(pair, (1, -1), strict=True):
                state[j] = self.round_number(z[j] + sign * width)
            states += pair
            steps.append(gmpy2.mpq(pair[0][j] - pair[1][j]))
        ends = self._ends(states, place, h)
        column, blur = [], []
        for i in range(len(z)):
            slopes = [
                gmpy2.mpfr((gmpy2.mpq(ahead[i]) - gmpy2.mpq(behind[i])) / step)
                for ahead, behind, step in zip(ends[::2], ends[1::2], steps, strict=True)
            ]
            noises = [2 * scatter[i] / float(step) for step in steps]
            value, error = _select_derivative(slopes, noises, self.step.coarseness > 0)
            column.append(value)
            blur.append(error)
        return column, blur

    def _ends(
        self, states: Sequence[Sequence[Fraction]], place: TrialPlace, h: Fraction
    ) -> list[list[Fraction]]:
        ends = self.step.exactly(states, self.round_number(h), self.round_number(place.t))
        if self.step.periods:  # all ends are moved next to the first one
            first = ends[0]
            ends = [list(map(unwrap, end, first, self.step.periods)) for end in ends]
        return ends


def _select_derivative(
    slopes: Sequence["gmpy2.mpfr"], noises: Sequence[float], coarse: bool
) -> tuple["gmpy2.mpfr", float]:
    """Return the extrapolated value unless the last two slopes, of tiny widths, contradict it.

    They contradict it if the map jumps within the wider differences, as where it wraps or a loop
    does one iteration more: the tiny ones lie on one side of the jump. With coarse numbers, neither
    is certain.
    """
    *wide, twice, tiny = slopes
    value, error = _extrapolate(wide, noises)
    noise = 2 * noises[-1]
    apart = abs(float(tiny - value))
    bent = abs(float(wide[0] - value)) * (noises[0] / noises[-1]) ** 2  # over the tiny width
    if not coarse and apart <= error + 4 * (noise + bent):
        return value, error
    agree = abs(float(tiny - twice)) <= 4 * noise
    return (tiny, noise + bent) if agree and not coarse else (value, error + apart)


def _extrapolate(
    slopes: Sequence["gmpy2.mpfr"], noises: Sequence[float]
) -> tuple["gmpy2.mpfr", float]:
    """Return the value of the extrapolation table whose error is least, and that error."""
    best, least_error = slopes[-1], float("inf")
    previous_row: list[gmpy2.mpfr] = []
    for k, slope in enumerate(slopes):
        row = [slope]
        for m, coarser in enumerate(previous_row, start=1):
            # Central differences have even powers of the width alone: halving it divides them by 4,
            # 16, ….
            row.append(row[-1] + (row[-1] - coarser) / (4**m - 1))
            # Both neighbours: one alone may agree by chance.
            error = max(abs(float(row[m] - row[m - 1])), abs(float(row[m] - coarser)))
            error = error + 2 * noises[k]
            if error < least_error:
                best, least_error = row[m], error
        previous_row = row
    if least_error != least_error or least_error == float("inf"):
        raise StepError("its differences are not finite")
    return best, least_error
