"""The exact solution through one initial value in closed form: what a named system knows of it.

The same formulas serve one initial value and a batch of them (`verify.arithmetic.batch`): where
they branch, all of the batch must take the same way, else they raise MixedError.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from verify.arithmetic.float_context import FloatContext

Context = Any  # mpmath's MPContext, which has no type stubs, or verify.arithmetic.float_context's
Number = Any  # a real number of that context, or a Batch of them
Values = Mapping[str, Fraction]  # a system's parameters
State = tuple[Number, Number]  # p, q


@dataclass(frozen=True)
class Motion:
    """t ↦ (p, q) through one initial value, in closed form.

    `state(mp, t)` evaluates it in the context's precision, of which it may lose a few digits, and
    `lost` more. `blow_up(mp, sign)` is |t| where the solution ends, forwards (1) or backwards (−1)
    in time, None where it does not. `goes()`: how it goes to infinity as t grows, where it does so
    without an end; None where it stays bounded or blows up. `rest`: it stays where it is.
    """

    state: Callable[[Context, Number], State]
    method: str
    lost: int = 0
    blow_up: Callable[[Context, int], Number | None] = lambda _, __: None
    goes: Callable[[], str | None] = lambda: None
    rest: bool = False


def at_rest(p: Fraction, q: Fraction) -> Motion:
    """The motion that stays at an equilibrium."""
    return Motion(lambda mp, _: (number(mp, p), number(mp, q)), "at rest", rest=True)


Flow = Callable[[Values, Fraction, Fraction], Motion | None]
"""(parameters, p, q) ↦ the motion; None where these parameters have no closed form."""


def number(mp: Context, x: Fraction) -> Number:
    """An exact rational, or a batch of them, rounded once."""
    if isinstance(mp, FloatContext):
        return mp.rational(x)
    return mp.mpf(x.numerator) / x.denominator
