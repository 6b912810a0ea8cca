"""Coordinates that a step reduces by whole periods, such as an angle taken modulo 2π.

A periodic H has the same motion after a period, so that the ends of step and flow are compared
modulo the period. Periods are looked for only if a step of a tiny size ends far from the flow.
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

_PERIOD_DIGITS, _FIELD_DIGITS, _SLOPE_TOLERANCE = 60, 40, Fraction(1, 10**30)
_MIN_JUMP = 1e-2  # a coordinate is reduced if it ends farther from the flow
# After reduction the distance from the flow is at most _MULTIPLE_TOLERANCE + _STEP_FACTOR h², where
# the second term allows for the error of a step of order 1.
_MULTIPLE_TOLERANCE, _STEP_FACTOR = 1e-6, 8
# The field is compared at this number of points, and has to repeat at so many of them at least; at
# the others it is undefined.
_MAX_POINTS, _MIN_REPEATS = 4, 2
Real = TypeVar("Real", Fraction, "gmpy2.mpfr")
Periods = tuple[Fraction, ...]  # one for each coordinate, 0 for none; () if none is reduced
Ends = tuple[Sequence[Real], Sequence[Real]]  # the end of the step, and that of the flow


def unwrap(x: Real, near: Real, period: Fraction) -> Real:
    """Return x moved by whole periods next to `near`."""
    turns = round((x - near) / period) if period else 0
    return x - turns * period if turns else x


def find_wrapped_periods(
    ends: Iterable[Ends[Real]], hamiltonian: Hamiltonian, h: Fraction
) -> Periods:
    """Return the periods by which steps of the small size h are reduced.

    () if every step ends near the flow, or if a distance is no multiple of a period of H.
    """
    rows = [list(zip(*row, strict=True)) for row in ends]
    if not any(abs(x - y) > _MIN_JUMP for row in rows for x, y in row):
        return ()
    periods = periods_of(hamiltonian)
    tolerance = _MULTIPLE_TOLERANCE + _STEP_FACTOR * float(h) ** 2
    for row in rows:
        for (x, y), period in zip(row, periods, strict=True):
            if abs(unwrap(x, y, period) - y) > tolerance:
                return ()
    is_reduced = [
        any(abs(row[k][0] - row[k][1]) > _MIN_JUMP for row in rows) for k in range(len(periods))
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
    """Return the period of each coordinate from the sines in H, 0 if H's field does not repeat."""
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
    whole = Fraction(str((2 * sympy.pi / slowest).evalf(_PERIOD_DIGITS)))
    # Products such as sin·cos repeat after half the period already.
    return next((x for x in (whole / 2, whole) if _repeats(hamiltonian, place, x)), Fraction(0))


def _repeats(hamiltonian: Hamiltonian, place: int, period: Fraction) -> bool:
    """Return True if the field is the same after that period, at all points where it is defined,
    and at two at least."""
    flow, repeats = NumericalFlow(canonical_field(hamiltonian)[0], _FIELD_DIGITS), 0
    names = hamiltonian.coordinates
    for index in range(_MAX_POINTS):
        point = [Fraction(2 * k + 3 * index + 1, 11) for k in range(len(names))]
        shifted = [x + period * (k == place) for k, x in enumerate(point)]
        try:
            one, two = (
                flow.slope(flow.state({**dict(zip(names, z, strict=True)), "t": Fraction(1, 4)}))
                for z in (point, shifted)
            )
        except NoFlowError:
            continue
        if any(abs(x - y) > _SLOPE_TOLERANCE * (1 + abs(x)) for x, y in zip(one, two, strict=True)):
            return False
        repeats += 1
    return repeats >= _MIN_REPEATS
