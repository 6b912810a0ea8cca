"""Period and average of random orbits against mpmath's own Taylor integrator and quadrature."""

from fractions import Fraction

import mpmath
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.examples import drawn
from tests.helpers.sampled.formulas import P, Q, plain
from tests.property.studies.test_growth_law import wells
from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.flows.extrapolation import NoFlowError
from verify.flows.orbit_average import average
from verify.hamiltonians.hamiltonian import Hamiltonian

DIGITS = 15
starts = st.integers(-8, 8).map(lambda n: Fraction(n, 10))


@pytest.mark.left_to_ci
@drawn(6)
@given(wells(), starts, starts)
def test_after_one_period_the_flow_is_back_and_the_integral_is_that_of_the_average(
    formula: str, p: Fraction, q: Fraction
) -> None:
    ring, (g,) = embed([parse("q**2 + p*q/3 - p**3")], ("p", "q"))
    try:
        found = average(Hamiltonian.parse(formula), (ring, g), (p, q), DIGITS)
    except NoFlowError:
        assume(False)
        raise
    assume(found.period is not None)
    assert found.period is not None
    hamiltonian = plain(formula)
    slopes = [-hamiltonian.diff(Q), hamiltonian.diff(P), Q**2 + P * Q / 3 - P**3]
    with mpmath.workdps(19):
        at = [sympy.lambdify((P, Q), slope, "mpmath") for slope in slopes]
        start = [mpmath.mpf(x.numerator) / x.denominator for x in (p, q)]
        flow = mpmath.odefun(lambda _, y: [f(y[0], y[1]) for f in at], 0, [*start, mpmath.mpf(0)])
        period, mean = (mpmath.mpf(x.numerator) / x.denominator
                        for x in (found.period[0], found.value))  # fmt: skip
        end = flow(period)
        near = mpmath.mpf(10) ** -(DIGITS - 2)
        assert abs(end[0] - start[0]) + abs(end[1] - start[1]) < near
        assert abs(end[2] / period - mean) < near
        half = flow(period / 2)  # and not after half of it
        assert abs(half[0] - start[0]) + abs(half[1] - start[1]) > 1e-3
