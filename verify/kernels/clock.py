"""The time t₀ + k h at which step k of a kernel is made, without an error that accumulates.

Floating point: k is carried, an exact number, and t₀ + k h is rounded three times in addition to t₀
itself. Fixed point: t₀ and h in the format are carried and added, which is exact; the parts that
the format cuts off from both are carried with them, 2^60 times as large, so that t is right to its
last place.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from verify.arithmetic.number import Number
from verify.arithmetic.number_system import Arithmetic

_PLACES = 60  # bits by which the cut-off remainder is scaled up
_ERRORS = 4  # roundings of t, each at most a unit of |t₀| + N h; in fixed point fewer


@dataclass(frozen=True)
class Clock:
    """Names of a kernel's `arguments` and of `carried` numbers, with the start's name or number;
    `now` is the statement that computes t at the beginning of a step, `later` are those at its
    end."""

    arguments: tuple[str, ...]
    carried: tuple[tuple[str, int | str], ...]
    now: str
    later: tuple[str, ...]
    absolute: bool

    def constants(self, arithmetic: Arithmetic) -> dict[str, Number]:
        """Return the constants that the statements name."""
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
    """Return the clock for kernels of this arithmetic."""
    return _FIXED if arithmetic.absolute else _FLOATING


def clock_inputs(arithmetic: Arithmetic, start: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return the values of a clock's arguments by their names."""
    if arithmetic.absolute:
        return {"h_rest": _cut(arithmetic, start["h"])}
    return {"t0": start["t"]}


def first_rest(arithmetic: Arithmetic, t: Fraction) -> dict[str, Fraction]:
    """Return the remainder that is carried with t from its start."""
    return {"t_rest": _cut(arithmetic, t)} if arithmetic.absolute else {}


def _cut(arithmetic: Arithmetic, x: Fraction) -> Fraction:
    """Return the part of x that the format cuts off, as it is carried."""
    # The remainder is exact: a rational minus the rational that the format holds.
    cut: Fraction = x - arithmetic.exact(arithmetic.number(x))
    return cut * (1 << _PLACES)


def error_of_time(arithmetic: Arithmetic, latest: Fraction) -> Fraction:
    """Return a bound on the error of t, `latest` being the greatest |t₀| + k h."""
    # In fixed point a unit is absolute; in floating point it is relative to the largest time.
    unit = Fraction(1, 2**arithmetic.bits)
    return _ERRORS * unit * (1 if arithmetic.absolute else latest)
