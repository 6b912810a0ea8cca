"""The time t₀ + k h at which step k of a kernel is made, so that nothing adds up in it.

Floating point: k is carried, an exact number, and t₀ + k h is rounded three times beside t₀ itself.
Fixed point: t₀ and h in the format are carried and added, which is exact; what the format cuts off
from both is carried beside them, 2^60 times as large, so that t is right to its last place.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic

_PLACES = 60  # bits by which what is cut off is carried larger
_ERRORS = 4  # roundings of t, each at most a unit of |t₀| + N h; in fixed point fewer


@dataclass(frozen=True)
class Clock:
    """`arguments` and `carried` names of a kernel, with the start's name or number; `now`, the
    statement that makes t at a step's beginning, and `later` what is said at its end.
    """

    arguments: tuple[str, ...]
    carried: tuple[tuple[str, int | str], ...]
    now: str
    later: tuple[str, ...]
    absolute: bool

    def constants(self, arithmetic: Arithmetic) -> dict[str, Number]:
        """What the statements name beside."""
        return {} if self.absolute else {"clock_one": arithmetic.number(Fraction(1))}


_FLOATING = Clock(
    ("t0",), (("step", 0),), "t = t0 + step * h", ("step = step + clock_one",), absolute=False
)
_FIXED = Clock(
    ("h_rest",),
    (("clock", "t"), ("clock_rest", "t_rest")),
    f"t = clock + shifted(clock_rest, {_PLACES})",
    ("clock = clock + h", "clock_rest = clock_rest + h_rest"),
    absolute=True,
)


def clock_of(arithmetic: Arithmetic) -> Clock:
    """How kernels of this arithmetic tell the time."""
    return _FIXED if arithmetic.absolute else _FLOATING


def clock_inputs(arithmetic: Arithmetic, start: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """The values of a clock's arguments by their names."""
    if arithmetic.absolute:
        return {"h_rest": _cut(arithmetic, start["h"])}
    return {"t0": start["t"]}


def first_rest(arithmetic: Arithmetic, t: Fraction) -> dict[str, Fraction]:
    """What is carried from t on beside p, q and t."""
    return {"t_rest": _cut(arithmetic, t)} if arithmetic.absolute else {}


def _cut(arithmetic: Arithmetic, x: Fraction) -> Fraction:
    """What the format cuts off from x, as it is carried."""
    cut: Fraction = x - arithmetic.exact(arithmetic.number(x))
    return cut * (1 << _PLACES)


def error_of_time(arithmetic: Arithmetic, latest: Fraction) -> Fraction:
    """A bound of how far t may be off, `latest` being the greatest |t₀| + k h."""
    unit = Fraction(1, 2**arithmetic.bits)
    return _ERRORS * unit * (1 if arithmetic.absolute else latest)
