"""A user's own step or map as it is called, z → z', and the type of the numbers that it takes.

A step has an h, and perhaps a t; a map has neither. All calls of either go through here: in floats,
in our number classes (symbols, dual numbers), or in the number type of another program.
"""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import gmpy2

from verify.arithmetic.exact import fraction
from verify.errors import unknown_name
from verify.integrators.places.trial_places import TrialPlace
from verify.integrators.user_code.layout import CallLayout, OfNumber
from verify.integrators.user_code.step import TIME_LIMIT, StepError, Theirs, limit_call, to_float


@dataclass(frozen=True)
class NumberType:
    """A type of floating-point numbers.

    `bits`: of the significand. `declared`: its name in C. `digits`: the number of significant
    decimals that tell any two of its numbers apart. `parts`: the number of doubles whose sum is one
    number; 1 for any other type.
    """

    name: str
    bits: int
    declared: str
    digits: int
    parts: int = 1

    @property
    def declared_as(self) -> str:
        """The name of the type in a sentence."""
        return self.name if self.parts > 1 else self.declared

    @property
    def epsilon(self) -> float:
        """The distance between 1 and the next number."""
        return 2.0 ** (1 - self.bits)

    def round_number(self, x: Fraction) -> Fraction:
        """Return the nearest number of the type; only for doubles is its range respected."""
        if self.parts > 1:
            return sum(map(Fraction, two_doubles(x)), Fraction(0))
        if self is DOUBLE:
            return Fraction(float(x))
        return fraction(gmpy2.mpfr(gmpy2.mpq(x), self.bits))


def two_doubles(x: Fraction) -> tuple[float, float]:
    """Return the double nearest to x, and the double nearest to the rest."""
    # The sum of the two has at least 106 bits.
    high = float(x)
    return high, float(x - Fraction(high))


DOUBLE = NumberType("double", 53, "double", 17)
LONG_DOUBLE = NumberType("long-double", 64, "long double", 21)
FLOAT128 = NumberType("float128", 113, "__float128", 36)
DOUBLE_DOUBLE = NumberType("double-double", 106, "double", 33, parts=2)
TYPES = {each.name: each for each in (DOUBLE, LONG_DOUBLE, FLOAT128, DOUBLE_DOUBLE)}


def type_of(name: str) -> NumberType:
    """Return the type of that name. Raises InputError for an unknown name."""
    if name not in TYPES:
        raise unknown_name(
            "--type", name, TYPES, aliases={"quad": "float128", "binary128": "float128"}
        )
    return TYPES[name]


State = tuple[float, ...]
_SHARE_FOR_FLOATS = 0.4  # a part of the time that is left; dual numbers, which are slow, come first


@dataclass
class UserMap:
    """A user's function with all that is needed to call it.

    `names`: of the coordinates, p and q or p1 … pn, q1 … qn. `parameters`: further arguments, by
    name. `limit`: the seconds for all calls and computations together; they end at `until`, on the
    clock of time.monotonic, which starts with the first call. `time_dependent`: True if H depends
    on t; otherwise the function is called with t = 0. `numbers`: the type in which it computes.
    `foreign`: True if it is written in another language, so that it takes numbers alone, no
    symbols. `periods`: of each coordinate, if the function reduces coordinates modulo periods.
    `masses`: the factors that make momenta of the function's p, if these are velocities.
    `coarseness`: the size of the jumps of z', relative to z', if the function's numbers are coarser
    than their type.
    """

    function: Callable[..., Theirs]
    layout: CallLayout
    names: tuple[str, ...]
    parameters: Mapping[str, Fraction] = field(default_factory=dict)
    limit: float = TIME_LIMIT
    until: float | None = None
    time_dependent: bool = False
    numbers: NumberType = DOUBLE
    foreign: bool = False
    periods: tuple[Fraction, ...] = ()
    masses: tuple[Fraction, ...] = ()
    coarseness: float = 0.0

    @property
    def seconds_left(self) -> float:
        """The seconds that are left; the first reading starts the clock."""
        if self.until is None:
            self.until = time.monotonic() + self.limit
        return self.until - time.monotonic()

    def hold_back(self, seconds: float) -> None:
        """Take seconds off the time that is left; a negative number gives them back."""
        self.until = time.monotonic() + self.seconds_left - seconds

    @property
    def degrees(self) -> int:
        """The degrees of freedom."""
        return len(self.names) // 2

    @property
    def takes_step_size(self) -> bool:
        """True if it is a step, with an h."""
        return self.layout.takes_step_size

    @property
    def takes_time(self) -> bool:
        """True if it takes t."""
        return self.layout.takes_time

    @property
    def probe_kinds(self) -> tuple[str, ...]:
        """The kinds of probe that can measure it, the sharpest first."""
        return ("floats",) if self.foreign else ("duals", "floats")

    def try_probes(self) -> Iterator[str]:
        """Yield the kinds of probe, with a part of the time held back for the last of them."""
        first, *others = self.probe_kinds
        reserve = _SHARE_FOR_FLOATS * max(self.seconds_left, 0) if others else 0.0
        self.hold_back(reserve)
        try:
            yield first
        finally:  # also where it has sufficed
            self.hold_back(-reserve)
        yield from others

    def call(
        self,
        function: Callable[..., Theirs],
        z: Sequence[Theirs],
        h: Theirs,
        t: Theirs,
        number: OfNumber,
    ) -> list[Theirs]:
        """Return z' of the function, or of a copy of it.

        `number`: converts a parameter or a mass to the numbers in which the function is called.
        Raises StepError, and what the user's code raises.
        """
        masses = [number(x) for x in self.masses]
        if masses:
            # The function computes with velocities: p/m goes in, and m v comes out as p.
            z = [*(x / m for x, m in zip(z, masses, strict=False)), *z[len(masses) :]]
        options = {name: number(x) for name, x in self.parameters.items()}
        with limit_call(self):
            result = function(*self.layout.arguments(z, h, t), **options)
            state = self.layout.state(result, len(self.names))
        if masses:
            state = [*(x * m for x, m in zip(state, masses, strict=False)), *state[len(masses) :]]
        return state

    def evaluate(self, z: Sequence[float], h: float, t: float) -> State:
        """Return z' as floats. Raises StepError, also if a number is not finite."""
        state = tuple(map(to_float, self.call(self.function, z, h, t, float)))
        if not all(map(math.isfinite, state)):
            numbers = ", ".join(f"{x:g}" for x in state)
            raise StepError(f"it returns what is not finite ({numbers}){self.describe_call(z, h)}")
        return state

    def exactly(
        self, states: Sequence[Sequence[Fraction]], h: Fraction, t: Fraction
    ) -> list[list[Fraction]]:
        """Return z' of each z, without rounding beyond the function's own type.

        Raises StepError as `evaluate` does.
        """
        # Another program answers many calls in one exchange, which takes a fraction of the time.
        several = getattr(self.function, "several", None)
        if several is not None and not self.masses:
            return self._together(several, states, h, t)
        return [self._of_its_type(z, h, t) for z in states]

    def _of_its_type(self, z: Sequence[Fraction], h: Fraction, t: Fraction) -> list[Fraction]:
        if self.numbers is DOUBLE:
            return [Fraction(x) for x in self.evaluate([float(x) for x in z], float(h), float(t))]
        return [Fraction(x) for x in self.call(self.function, z, h, t, Fraction)]

    def _together(
        self, several: Callable[..., Theirs], states: Sequence[Sequence[Fraction]], h: Fraction,
        t: Fraction,
    ) -> list[list[Fraction]]:  # fmt: skip
        """Return z' of all states by one exchange with another program."""
        n = self.degrees
        with limit_call(self, "calls of it do not end"):
            answers = several([(z[:n], z[n:], t, h) for z in states])
        for answer in answers:
            if isinstance(answer, StepError):
                raise answer
        return [[Fraction(x) for half in answer for x in half] for answer in answers]

    def at_place(self, place: TrialPlace, h: Fraction) -> State:
        """Return z' of a step from that place, as floats; raises as `evaluate` does."""
        return self.evaluate([float(x) for x in place.z], float(h), float(place.t))

    def entry_name(self, indices: tuple[int, int]) -> str:
        """Return the name of an entry of S, such as dp1∧dq1."""
        return "∧".join(f"d{self.names[k]}" for k in indices)

    def describe_state(self, z: Sequence[float | Fraction]) -> str:
        """Format a state, for messages."""
        return ", ".join(f"{name} = {float(x):g}" for name, x in zip(self.names, z, strict=True))

    def describe_call(self, z: Sequence[float | Fraction], h: float | Fraction) -> str:
        """Format a state and a step size, for messages on a call."""
        step_size = f", h = {float(h):g}" if self.takes_step_size else ""
        return f" at {self.describe_state(z)}{step_size}"
