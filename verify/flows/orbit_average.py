"""Time averages along closed orbits of the exact flow, to a requested number of digits.

⟨g⟩ is the mean of g over M equally spaced times of one period: for an analytic g that converges
like e^(−cM), so M is doubled until the mean over every second point is the same. Then the period,
the points and the mean are computed again with ten digits more and 3M/2 points, among which other
harmonics alias. The difference of the two means estimates the error; that is no certificate.

The bounded part of ∫ g dt is a function B with X B = g − ⟨g⟩ (X is the derivative along the flow):
the integral of the Fourier series of g. B is smooth on every ring of closed orbits, and is
determined up to a function of the orbit.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import is_representable, midpoint_and_radius
from verify.arithmetic.flint_precision import working_precision
from verify.flows.closed_orbit import ClosedOrbit, Element, Start, closed_orbit
from verify.flows.extrapolation import NoFlowError, Number, State
from verify.hamiltonians.hamiltonian import Hamiltonian

MOST_DIGITS = 200
_ATTEMPTS = ((0, 32), (15, 64), (30, 128))  # (digits beyond the requested, first number of points)
_MOST_POINTS = 1 << 13
_CHECK_DIGITS = 10  # extra digits of the second computation
_NEWTON_STEPS = 50
_PHASE_TOLERANCE = 1e-14  # Newton's last change of a time, in spacings of the orbit's points


@dataclass(frozen=True)
class Average:
    """The average ⟨g⟩ over a closed orbit, with the points that the mean was taken over.

    `bound` is an estimate, except at an equilibrium, where ⟨g⟩ = g(z₀) is enclosed and `period` is
    None. `values` are g at the orbit's points.
    """

    value: Fraction
    bound: Fraction
    period: tuple[Fraction, Fraction] | None  # with its bound
    orbit: ClosedOrbit
    values: tuple[float, ...]


def average(hamiltonian: Hamiltonian, g: Element, start: Start, digits: int) -> Average:
    """Return ⟨g⟩ along the exact orbit through start = (p, q), to within 10^−digits max |g|.

    g: a ring element in p and q alone. Raises NoFlowError if the orbit is not closed or was not
    seen to close, and if the digits are not reached.
    """
    for more, fewest in _ATTEMPTS:
        first = closed_orbit(hamiltonian, start, digits + more, fewest)
        if first.period is None:
            return _at_rest(first, g, start, digits)
        first, mean = _refine_until_settled(first, g, digits)
        finest = digits + more + _CHECK_DIGITS
        # 3/2 as many points alias other harmonics, so that equal means are no accident.
        finer = closed_orbit(hamiltonian, start, finest, len(first.points) * 3 // 2)
        finer_mean = _compute_mean(finer, g)
        to_fraction = finer.flow.arithmetic.exact
        before, period = to_fraction(first.period), to_fraction(finer.period)
        period_error = abs(period - before) + _last_digit(finest) * period
        bound = abs(finer_mean.value - mean.value) + _last_digit(finest) * finer_mean.size
        if (
            period_error <= _last_digit(digits) * period
            and bound <= _last_digit(digits) * finer_mean.size
        ):
            return Average(
                finer_mean.value, bound, (period, period_error), finer, finer_mean.values
            )
    raise NoFlowError(f"{digits} digits of the average were not reached")


def _refine_until_settled(
    orbit: ClosedOrbit, g: Element, digits: int
) -> tuple[ClosedOrbit, "_Mean"]:
    """Double the orbit's points until the mean over every second one is the same to `digits`."""
    mean = _compute_mean(orbit, g)
    while len(orbit.points) < _MOST_POINTS:
        half_mean, orbit = mean, orbit.finer()
        mean = _compute_mean(orbit, g)
        if abs(mean.value - half_mean.value) <= _last_digit(digits) * mean.size:
            return orbit, mean
    raise NoFlowError(f"{_MOST_POINTS} points are too few for {digits} digits of the average")


@dataclass(frozen=True)
class _Mean:
    value: Fraction
    size: Fraction  # the greatest |g|
    values: tuple[float, ...]


def _compute_mean(orbit: ClosedOrbit, g: Element) -> _Mean:
    numbers = [orbit.flow.arithmetic.exact(x) for x in orbit.values(g)]
    mean = sum(numbers, Fraction(0)) / len(numbers)
    return _Mean(mean, max(map(abs, numbers)), tuple(map(float, numbers)))


def _last_digit(digits: int) -> Fraction:
    return Fraction(1, 10**digits)


def _at_rest(orbit: ClosedOrbit, g: Element, start: Start, digits: int) -> Average:
    """Return the average at an equilibrium, g(z₀), enclosed."""
    ring, x = g
    bits = 4 * digits + 64
    value = enclose(ring, x, {"p": start[0], "q": start[1]}, bits)
    with working_precision(bits):
        if value is None or not is_representable(value):
            raise NoFlowError("the function is not defined at the equilibrium")
        middle, radius = midpoint_and_radius(value)
    return Average(middle, radius, None, orbit, (float(middle),))


# -- the bounded part -----------------------------------------------------------------------------


def bounded_part(orbit_average: Average) -> Callable[[State], float]:
    """Return z ↦ B(z) − B(z₀) for z near the orbit, with B of the module's text, in float64.

    It takes B at the point of the orbit nearest to z, with an error of O(|H(z) − H(z₀)|).
    """
    import numpy as np

    if orbit_average.period is None:
        return lambda z: 0.0
    count = len(orbit_average.values)
    harmonics = np.arange(1, count // 2)
    # The integral of e^(iωs) from 0 to t is (e^(iωt) − 1)/(iω); `expm1` loses no digits of it.
    rates = 2j * np.pi * harmonics / float(orbit_average.period[0])
    weights = np.fft.fft(orbit_average.values)[1 : count // 2] / count / rates

    def evaluate(z: State) -> float:
        time = phase(orbit_average.orbit, z)
        return float(2 * np.real(np.sum(weights * np.expm1(rates * time))))

    return evaluate


def phase(orbit: ClosedOrbit, z: State) -> float:
    """Return the time t at which φ_t(z₀) is nearest to z, which must be near the orbit."""
    # On a rotation z may be whole periods of H away from the orbit's points, which cover one.
    z = _remove_turns(orbit, z)
    nearest = min(range(len(orbit.points)), key=lambda k: _squared_distance(z, orbit.points[k]))
    point, time = orbit.points[nearest], float(orbit.time(Fraction(nearest, len(orbit.points))))
    # The nearest time is less than one spacing of the points away.
    most = float(orbit.time(Fraction(1, len(orbit.points))))
    for _ in range(_NEWTON_STEPS):
        p, q = orbit.flow.slope(point)
        change = float((p * (z[0] - point[0]) + q * (z[1] - point[1])) / (p * p + q * q))
        change = max(-most, min(most, change))
        point = orbit.flow.advance(point, orbit.flow.number(Fraction(change)))
        time += change
        if abs(change) < _PHASE_TOLERANCE * most:
            break
    return time


def _remove_turns(orbit: ClosedOrbit, z: State) -> State:
    """Subtract whole shifts from z, so that it lies beside the orbit's points."""
    first = orbit.points[0]
    coordinates = []
    for x, x0, shift in zip(z, first, orbit.shift, strict=True):
        turns = Fraction(int(((x - x0) / shift) // 1)) if shift else Fraction(0)
        with orbit.flow.arithmetic.context():
            coordinates.append(x - orbit.flow.number(turns) * shift)
    return coordinates[0], coordinates[1]


def _squared_distance(z: State, target: State) -> Number:
    return (z[0] - target[0]) ** 2 + (z[1] - target[1]) ** 2
