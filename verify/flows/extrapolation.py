"""The exact flow to any number of digits: Gragg's method, extrapolated (Bulirsch and Stoer).

The modified midpoint rule has an expansion in even powers of its step, so that its results with
2, 4, 6, … steps extrapolate to any order (Hairer, Nørsett, Wanner, Solving Ordinary Differential
Equations I, section II.9). It evaluates only H_p and H_q. Its error is estimated from the last
two extrapolated values; a caller that needs a surer bound compares with a run of more digits.

Where H depends on time a state is (p, q, t): with t' = 1 the system is autonomous, and Gragg's rule
takes its midpoints at t, t + h, t + 2h, …
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from verify.arithmetic.systems import mpfr
from verify.flows.compiled_functions import ElementCode
from verify.hamiltonians.canonical_field import PlainField
from verify.prose import read_prose

Number = Any  # gmpy2.mpfr, which has no type stubs
State = tuple[Number, ...]  # the coordinates, and t where H depends on it

GUARD = 12  # digits beyond those requested; extrapolation and rounding may lose LOST_DIGITS
LOST_DIGITS = 8
_HALVINGS = 12
_MOST_STEPS = 200_000  # a limit for one orbit; they take minutes
_PATIENCE = 3  # good steps after a failed one, before a longer one is tried
_MOST_CUTS = 80  # halvings of the first step; the orbit is given up below that step
LOST = "the orbit comes to rest, leaves where H is defined, or becomes too fast to be followed"
STILL = 1000  # a step's error is relative to its distance plus 1/STILL of the state's size


class NoFlowError(Exception):
    """An exact flow that could not be followed; `reason` says why, the message is its plain text.

    `reason` is written for `read_prose`: its formulas and numbers stand in backquotes.
    """

    def __init__(self, reason: str) -> None:
        self.reason = read_prose(reason)
        super().__init__(str(self.reason))


def columns_for(digits: int) -> int:
    """Return the limit of the columns of the extrapolation; a shorter step gains more than more."""
    return 6 + digits // 3


class NumericalFlow:
    """The exact flow of a field without symbols, in n degrees of freedom, to `digits` digits.

    A state has all coordinates, and t where H depends on it.
    """

    def __init__(self, field: PlainField, digits: int) -> None:
        names, self.timed = field.names, field.timed
        self.arithmetic = mpfr.make(digits + GUARD)
        self.names = (*names, "t") if self.timed else tuple(names)
        slopes = [(field.ring, x) for x in field.slopes]
        code = ElementCode.from_elements(self.arithmetic, slopes, self.names)
        self._slopes, self._rule = code.build_function(), code.build_gragg_rule()
        self._tolerance = self.arithmetic.number(Fraction(1, 10 ** (digits + GUARD - LOST_DIGITS)))
        self._factors = [
            # 1 / ((n_j / n_{j−k})² − 1) with n_j = 2 j, as a quotient of whole numbers
            [((j - k) ** 2, j**2 - (j - k) ** 2) for k in range(1, j)]
            for j in range(1, columns_for(digits) + 1)
        ]

    def number(self, x: Fraction) -> Number:
        return self.arithmetic.number(x)

    def state(self, point: Mapping[str, Fraction]) -> State:
        """Return z at a point: the coordinates by name, and t where H depends on it."""
        return tuple(self.number(point[name]) for name in self.names)

    def slope(self, z: State) -> State:
        """Return f(z). Raises NoFlowError if it is not defined."""
        try:
            with self.arithmetic.context():
                return self._slopes(*z)
        except (ArithmeticError, ValueError):
            raise NoFlowError("the orbit leaves where H is defined") from None

    def step(self, z: State, time: Number) -> State | None:
        """Return φ_time(z) by one extrapolated step; None if its error is estimated too large."""
        try:
            with self.arithmetic.context():
                return self._extrapolate(z, time)
        except (
            ArithmeticError,
            ValueError,
        ):  # a trial step may leave the domain of H
            return None

    def advance(self, z: State, time: Number, halvings: int = _HALVINGS) -> State:
        """Return φ_time(z) by extrapolated steps, halved where they fail. Raises NoFlowError."""
        end = self.step(z, time)
        if end is not None:
            return end
        if not halvings:
            raise NoFlowError(LOST)
        with self.arithmetic.context():
            half = time / 2
        middle = self.advance(z, half, halvings - 1)
        return self.advance(middle, half, halvings - 1)

    def follow(self, z: State, time: Fraction, most_steps: int = _MOST_STEPS) -> State:
        """Return φ_time(z) for a time of any length and sign, by at most `most_steps` steps.

        A step is as long as its accuracy allows; one of 30 digits takes about a millisecond. Raises
        NoFlowError, naming the time reached, if the orbit ends or the steps are used up.
        """
        number = self.number
        goal, done = number(abs(time)), number(Fraction(0))
        sign = -1 if time < 0 else 1
        good = _PATIENCE
        step = self._first_step(z, goal)
        shortest = step / 2**_MOST_CUTS
        for _ in range(most_steps):
            if done >= goal:
                return z
            with self.arithmetic.context():
                last = done + step >= goal
                step = goal - done if last else step
                directed_step = sign * step
            after = self.step(z, directed_step)
            with self.arithmetic.context():
                if after is None:
                    # The step failed: it is cut, and no longer one is tried for `_PATIENCE` steps.
                    good, step = 0, step * 2 / 3
                    if step < shortest or done + step == done:
                        raise NoFlowError(f"{LOST}, at about t = `{float(sign * done):.6g}`")
                else:
                    z, done, good = after, goal if last else done + step, good + 1
                    step = step * 3 / 2 if good > _PATIENCE else step
        raise NoFlowError(f"{most_steps} steps lead only to t = `{float(sign * done):.6g}`")

    def _first_step(self, z: State, goal: Number) -> Number:
        """Guess a first step: the time in which z would change by its own size."""
        slopes = self.slope(z)
        with self.arithmetic.context():
            speed = sum(map(abs, slopes))
            return min(goal, sum(map(abs, z[: len(slopes)]), 1) / speed) if speed else goal

    def _extrapolate(self, z: State, time: Number) -> State | None:
        """Extrapolate by the Aitken–Neville scheme in the squared substep; None if inaccurate.

        The last two values of a row estimate the error: the result is taken where they differ by
        less than the tolerance, relative to how far the step leads and to 1/`STILL` of the state.
        """
        # The previous row of the scheme, for each coordinate.
        above: Sequence[Sequence[Number]] = [[] for _ in z]
        for j, factors in enumerate(self._factors, start=1):
            rows, distance, size, error = [], 0, 0, 0
            for last, start, before in zip(self._rule(*z, time, 2 * j), z, above, strict=False):
                x, row = last, [last]
                for old, (up, down) in zip(before, factors, strict=True):
                    x = x + (x - old) * up / down
                    row.append(x)
                rows.append(row)
                if j > 2:
                    distance += abs(x - start)
                    size += abs(x)
                    error += abs(x - row[-2])
            # At least three columns: the last two of fewer may agree by chance.
            if j > 2 and error <= self._tolerance * (distance + size / STILL):
                ends = [row[-1] for row in rows]
                return (*ends, z[-1] + time) if self.timed else tuple(ends)
            above = rows
        return None
