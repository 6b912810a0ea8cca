"""At which time a measured step reads H in the mean, where that is why its order is 1.

A step that reads H(p, q, t) at t + c_i h, in parts b_i of it, has p' − p(t + h) =
−(Σ b_i c_i − 1/2) H_qt h² + O(h³) where nothing else is wrong, and so for q with H_pt. Where that
quotient is the same at every point, Σ b_i c_i is the mean; where something else is wrong it is not.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy

from verify.algebra.formula import symbol
from verify.integrators.probe import Trial, flow_of
from verify.integrators.step_probes import PROBES, Point
from verify.integrators.tracing.misread import moment

_SIZES = {"duals": Fraction(1, 2**20), "floats": Fraction(1, 2**9)}
_NEAR = {"duals": Fraction(1, 10**6), "floats": Fraction(1, 200)}  # of each other, in parts of h
_LARGEST_PART = 12  # the denominator of a mean that is read off what is so near
_FEWEST, _LEAST = 2, 0.01  # points, and the size of H_qt or H_pt


def mean_time(trial: Trial, how: str) -> list[str]:
    """One sentence, where the mean is seen and is not the right one. Raises what the user's code
    raises."""
    means = [x for point in trial.points for x in _means(trial, how, point)]
    near = _NEAR[how]
    if (
        len(means) < _FEWEST
        or max(means) - min(means) > near
        or abs(means[0] - Fraction(1, 2)) < near
    ):
        return []
    found = sum(means, Fraction(0)) / len(means)
    read = found.limit_denominator(_LARGEST_PART)
    told = moment(read) if abs(read - found) <= near else f"about t {float(found):+.3f} h"
    return [f"H is read at {told} in the mean: it can be of order 2 where that is t + h/2"]


def _means(trial: Trial, how: str, point: Point) -> Iterator[Fraction]:
    """Of p' and of q', where H's derivative is large enough."""
    h = _SIZES[how]
    gaps = [_gap(trial, how, point, x) for x in (h, h / 2)]
    at = dict(zip("pqt", (*point, trial.step.clock(*point)), strict=True))
    values = {symbol(name): sympy.Rational(x.numerator, x.denominator) for name, x in at.items()}
    for k, (by, sign) in enumerate((("q", -1), ("p", 1))):
        slope = sign * trial.hamiltonian.exact.diff(symbol(by), symbol("t")).subs(values)
        size = Fraction(float(slope))
        one, two = gaps[0][k] / h**2, gaps[1][k] / (h / 2) ** 2
        if abs(size) > _LEAST:
            yield Fraction(1, 2) + (2 * two - one) / size
        elif abs(2 * two - one) > _LEAST:  # it is wrong where time has no part in it
            yield from (Fraction(0), Fraction(1))


def _gap(trial: Trial, how: str, point: Point, h: Fraction) -> Sequence[Fraction]:
    """p' and q' less the exact flow's."""
    probe, flow = PROBES[how](trial.step), flow_of(trial.hamiltonian, how, trial.step.numbers)
    here, _ = probe.end(point, h)
    start = tuple(map(flow.number, (*point, trial.step.clock(*point))))
    end = flow.advance(start, flow.number(h))
    with flow.arithmetic.context():
        return [
            Fraction(*map(int, (x - y).as_integer_ratio()))
            for x, y in zip(here, end[:2], strict=True)
        ]
