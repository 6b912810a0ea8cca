"""A user's own step or map as it is called, z → z', and the type of the numbers that it takes.

A step has an h, and perhaps a t; a map has neither. All calls of either go through here, in floats,
in numbers of ours, or in those of another program, whose types are told apart by their bits.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
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
    """`bits` of the significand. `parts`: doubles that one number is the sum of, or 1.

    `declared`: what C calls it. `digits`: decimals that tell any two of them apart.
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
        """Return the nearest number of the type, but for its range."""
        if self.parts > 1:
            return sum(map(Fraction, two_doubles(x)), Fraction(0))
        if self is DOUBLE:
            return Fraction(float(x))
        return fraction(gmpy2.mpfr(gmpy2.mpq(x), self.bits))


def two_doubles(x: Fraction) -> tuple[float, float]:
    """Return the nearest double, and that of the rest."""
    # The nearest double, then the nearest one to what is left: their sum has at least 106 bits.
    high = float(x)
    return high, float(x - Fraction(high))


DOUBLE = NumberType("double", 53, "double", 17)
LONG_DOUBLE = NumberType("long-double", 64, "long double", 21)
FLOAT128 = NumberType("float128", 113, "__float128", 36)
DOUBLE_DOUBLE = NumberType("double-double", 106, "double", 33, parts=2)
TYPES = {each.name: each for each in (DOUBLE, LONG_DOUBLE, FLOAT128, DOUBLE_DOUBLE)}


def type_of(name: str) -> NumberType:
    """Return the type of that name. Raises InputError for one that is not known."""
    if name not in TYPES:
        raise unknown_name(
            "--type", name, TYPES, aliases={"quad": "float128", "binary128": "float128"}
        )
    return TYPES[name]


State = tuple[float, ...]


@dataclass
class UserMap:
    """`names`: of the coordinates, p and q or p1 … pn, q1 … qn. `parameters`: further arguments by
    their names. `limit`: seconds for all that is done with it, which end at `until`, a moment of
    time.monotonic. `moving`: whether H depends on time; else its t is 0. `numbers`: the type that
    it computes in. `foreign`: it is of another language, so that numbers alone go in. `periods`: of
    each coordinate, where it is seen to reduce them so. `masses`: where its p are velocities, what
    makes momenta of them. `coarseness`: by how much z' is seen to jump, in parts of its size, where
    its numbers are coarser than their type.
    """

    function: Callable[..., Theirs]
    layout: CallLayout
    names: tuple[str, ...]
    parameters: Mapping[str, Fraction] = field(default_factory=dict)
    limit: float = TIME_LIMIT
    until: float | None = None
    moving: bool = False
    numbers: NumberType = DOUBLE
    foreign: bool = False
    periods: tuple[Fraction, ...] = ()
    masses: tuple[Fraction, ...] = ()
    coarseness: float = 0.0

    @property
    def left(self) -> float:
        """The seconds that are left."""
        if self.until is None:
            self.until = time.monotonic() + self.limit
        return self.until - time.monotonic()

    def hold_back(self, seconds: float) -> None:
        """Keep seconds for later; give them back where they are less than 0."""
        self.until = time.monotonic() + self.left - seconds

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
    def ways(self) -> tuple[str, ...]:
        """The ways in which it can be measured, the clearest first."""
        return ("floats",) if self.foreign else ("duals", "floats")

    def call(
        self,
        function: Callable[..., Theirs],
        z: Sequence[Theirs],
        h: Theirs,
        t: Theirs,
        number: OfNumber,
    ) -> list[Theirs]:
        """Return z' of the function, or of a copy of it. Raises StepError, and what the user's code
        raises.

        `number`: makes of a parameter what the function takes.
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
        """Return z' as floats. Raises StepError, also for what is not finite."""
        state = tuple(map(to_float, self.call(self.function, z, h, t, float)))
        if not all(map(math.isfinite, state)):
            numbers = ", ".join(f"{x:g}" for x in state)
            raise StepError(f"it returns what is not finite ({numbers}){self.place(z, h)}")
        return state

    def exactly(
        self, states: Sequence[Sequence[Fraction]], h: Fraction, t: Fraction
    ) -> list[list[Fraction]]:
        """Return z' of each z as the numbers of its type that they are. Raises StepError, as
        `evaluate`."""
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
        """Call all states by one exchange with another program."""
        n = self.degrees
        with limit_call(self, "calls of it do not end"):
            answers = several([(z[:n], z[n:], t, h) for z in states])
        for answer in answers:
            if isinstance(answer, StepError):
                raise answer
        return [[Fraction(x) for half in answer for x in half] for answer in answers]

    def at_place(self, place: TrialPlace, h: Fraction) -> State:
        """Return z' as floats of a step from there; as `evaluate`."""
        return self.evaluate([float(x) for x in place.z], float(h), float(place.t))

    def entry(self, indices: tuple[int, int]) -> str:
        """Return the name of an entry of S, such as dp1∧dq1."""
        return "∧".join(f"d{self.names[k]}" for k in indices)

    def state(self, z: Sequence[float | Fraction]) -> str:
        """Format a state, for messages."""
        return ", ".join(f"{name} = {float(x):g}" for name, x in zip(self.names, z, strict=True))

    def place(self, z: Sequence[float | Fraction], h: float | Fraction) -> str:
        """Format a state and a step size, for messages on a call."""
        return f" at {self.state(z)}" + (f", h = {float(h):g}" if self.takes_step_size else "")
