"""Coordinates that a step reduces by whole periods, such as an angle taken modulo 2π.

The motion of a periodic H is the same there, so that its ends are compared modulo the period. It is
looked for where a step of almost no length ends as far from the flow as a period, and nowhere else.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import gcd, lcm
from typing import TYPE_CHECKING, TypeVar

from verify.flows.extrapolation import NoFlowError, NumericalFlow
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Number, Prose, prose

if TYPE_CHECKING:
    import gmpy2

_DIGITS, _OF_FIELD, _SAME_SLOPE = 60, 40, Fraction(1, 10**30)
_FAR_FROM_FLOW = 1e-2  # from the flow, where a period is looked for
_TOLERANCE, _BY_STEP = 1e-6, 8  # of a whole multiple of it; and times h², for an error of order 1
_POINTS, _FEWEST = 4, 2  # at which the field is looked at, and has to repeat
Real = TypeVar("Real", Fraction, "gmpy2.mpfr")
Periods = tuple[Fraction, ...]  # of each coordinate, 0 for none; () where none is reduced
Ends = tuple[Sequence[Real], Sequence[Real]]  # of the step, and of the flow


def unwrap(x: Real, near: Real, period: Fraction) -> Real:
    """Move x by whole periods to where it is nearest to `near`."""
    turns = round((x - near) / period) if period else 0
    return x - turns * period if turns else x


def find_wrapped_periods(
    ends: Iterable[Ends[Real]], hamiltonian: Hamiltonian, h: Fraction
) -> Periods:
    """Find the periods by which steps of that small size end away from the flow."""
    rows = [list(zip(*row, strict=True)) for row in ends]
    if not any(abs(x - y) > _FAR_FROM_FLOW for row in rows for x, y in row):
        return ()
    periods = periods_of(hamiltonian)
    tolerance = _TOLERANCE + _BY_STEP * float(h) ** 2
    for row in rows:
        for (x, y), period in zip(row, periods, strict=True):
            if abs(unwrap(x, y, period) - y) > tolerance:
                return ()
    is_reduced = [
        any(abs(row[k][0] - row[k][1]) > _FAR_FROM_FLOW for row in rows)
        for k in range(len(periods))
    ]
    return tuple(x if wraps else Fraction(0) for x, wraps in zip(periods, is_reduced, strict=True))


def describe_periods(names: Sequence[str], periods: Periods) -> list[Prose]:
    """Return a sentence for each coordinate that is reduced."""
    return [
        prose(name, " is compared modulo ", Number(f"{float(x):.6g}"), ", a period of the motion")
        for name, x in zip(names, periods, strict=False)
        if x
    ]


def periods_of(hamiltonian: Hamiltonian) -> Periods:
    """Find the period of each coordinate from the sines in H, where H's field repeats with it."""
    return tuple(_period(hamiltonian, k) for k in range(2 * hamiltonian.degrees))


def _period(hamiltonian: Hamiltonian, place: int) -> Fraction:
    import sympy

    from verify.algebra.expressions.function_nodes import waves_in
    from verify.algebra.formula import symbol

    coordinate = symbol(hamiltonian.coordinates[place])
    waves = waves_in(hamiltonian.exact)
    rates = sorted({abs(x.args[0].diff(coordinate)) for x in waves} - {0}, key=str)
    ratios = [sympy.nsimplify(x / rates[0]) for x in rates]
    if not rates or not all(x.is_Rational for x in ratios) or rates[0].free_symbols:
        return Fraction(0)
    # The rates are r₀ p_i/q_i. With m the least common multiple of the q_i, all sines share the
    # period of the rate r₀ gcd(p_i m/q_i)/m.
    m = lcm(*(int(x.q) for x in ratios))
    slowest = rates[0] * sympy.Rational(gcd(*(int(x.p) * m // int(x.q) for x in ratios)), m)
    whole = Fraction(str((2 * sympy.pi / slowest).evalf(_DIGITS)))
    # Products such as sin·cos repeat after half the period already.
    return next((x for x in (whole / 2, whole) if _repeats(hamiltonian, place, x)), Fraction(0))


def _repeats(hamiltonian: Hamiltonian, place: int, period: Fraction) -> bool:
    """Return True if the field is the same after that period, at some points."""
    flow, repeats = NumericalFlow(canonical_field(hamiltonian)[0], _OF_FIELD), 0
    names = hamiltonian.coordinates
    for first in range(_POINTS):
        point = [Fraction(2 * k + 3 * first + 1, 11) for k in range(len(names))]
        shifted = [x + period * (k == place) for k, x in enumerate(point)]
        try:
            one, two = (
                flow.slope(flow.state({**dict(zip(names, z, strict=True)), "t": Fraction(1, 4)}))
                for z in (point, shifted)
            )
        except NoFlowError:
            continue
        if any(abs(x - y) > _SAME_SLOPE * (1 + abs(x)) for x, y in zip(one, two, strict=True)):
            return False
        repeats += 1
    return repeats >= _FEWEST
