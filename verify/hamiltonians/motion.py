"""The exact solution through one initial value in closed form, as a named system provides it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, fmpq

Values = Mapping[str, Fraction]  # a system's parameters
State = tuple[arb, arb]  # p, q


@dataclass(frozen=True)
class Motion:
    """t ↦ (p, q) through one initial value, in closed form and in balls.

    `state(t)`, t ≠ 0, and `blow_up(sign)` hold the true values, or are not finite, where flint's
    precision does not suffice: the caller then raises it. `blow_up`: |t| where the solution ends,
    forwards (1) or backwards (−1) in time, None where it does not; itself None where no such
    solution does. `goes()`: how it goes to infinity as t grows, where it does so without an end;
    None where it stays bounded or blows up. `rest`: it stays at its start.
    """

    state: Callable[[arb], State]
    method: str
    blow_up: Callable[[int], arb | None] | None = None
    goes: Callable[[], str | None] = lambda: None
    rest: bool = False


def at_rest(p: Fraction, q: Fraction) -> Motion:
    """Return the motion that stays at an equilibrium."""
    return Motion(lambda _: (arb(exactly(p)), arb(exactly(q))), "at rest", rest=True)


Flow = Callable[[Values, Fraction, Fraction], Motion | None]
"""(parameters, p, q) ↦ the motion; None where these parameters have no closed form."""


def exactly(x: Fraction) -> fmpq:
    """Return flint's rational."""
    return fmpq(x.numerator, x.denominator)
