"""Φ_(−h)(Φ_h(z)) by the step's own operations, beside the composition of its series, and beside
numbers: one step there and one back in mpmath."""

from typing import Any

import mpmath
import pytest

from verify.algebra.power_series import Series
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.steps.composition import compose, reverse, start_of, step_back
from verify.schemes.steps.step_algebra import Step, series_of

PENDULUM = "p**2/2 - cos(q)"
IN_TIME = "p**2/2 + q**4/4*cos(t) + q*sin(t)"
HENON_HEILES = "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3"
MIXED = "p**2*(1 + q**2)/2 + q**2/2"
SCHEMES = ("rk4", "stormer-verlet", "ruth3", "implicit-midpoint", "gauss4")
MOST = 5


def there_and_back(step: Step, field: Any) -> tuple[list[Series], list[Series]]:
    end = series_of(field, step, MOST)
    return step_back(field, step, end), compose(field, list(map(reverse, end)), end)


@pytest.mark.parametrize("formula", [PENDULUM, IN_TIME, HENON_HEILES])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_way_back_by_operations_is_the_composition_of_series(formula: str, scheme: str) -> None:
    step_map = get(scheme).step_map(Hamiltonian.parse(formula))
    assert step_map.step is not None
    back, composed = there_and_back(step_map.step, step_map.field)
    for x, y in zip(back, composed, strict=True):
        for a, b in zip(x.coefficients, y.coefficients, strict=True):
            assert step_map.ring.vanishes(a - b) is True


@pytest.mark.parametrize("formula", [MIXED, IN_TIME, HENON_HEILES])
def test_the_way_back_of_lie3_is_the_composition_of_its_series(formula: str) -> None:
    field = lie_map(Hamiltonian.parse(formula), 3).field
    back, composed = there_and_back(lambda algebra: algebra.along_flow(3), field)
    for x, y in zip(back, composed, strict=True):
        assert all(field.ring.vanishes(a - b) is True
                   for a, b in zip(x.coefficients, y.coefficients, strict=True))  # fmt: skip


@pytest.mark.parametrize("formula", [MIXED, HENON_HEILES])
def test_symplectic_euler_s_two_adjoints_undo_each_other(formula: str) -> None:
    step_map = get("implicit-symplectic-euler").step_map(Hamiltonian.parse(formula))
    assert step_map.step is not None
    back, _ = there_and_back(step_map.step, step_map.field)
    gaps = [x - z for x, z in zip(back, start_of(step_map.field, MOST), strict=True)]
    assert not all(gap.vanishes for gap in gaps)  # it is not symmetric
    assert all(gap.coefficients[0].is_zero() and gap.coefficients[1].is_zero() for gap in gaps)


def test_the_leading_coefficient_of_rk2_s_way_back_is_that_of_numbers() -> None:
    """Of the explicit midpoint rule for the pendulum: with 60 digits, at one point."""
    step_map = get("explicit-midpoint").step_map(Hamiltonian.parse(PENDULUM))
    assert step_map.step is not None
    back, _ = there_and_back(step_map.step, step_map.field)
    coefficient = step_map.ring.expression(back[0].coefficients[4])
    with mpmath.workdps(80):
        h = mpmath.mpf(10) ** -12

        def midpoint(p: Any, q: Any, s: Any) -> tuple[Any, Any]:
            p_half, q_half = p - s / 2 * mpmath.sin(q), q + s / 2 * p
            return p - s * mpmath.sin(q_half), q + s * p_half

        p, q = mpmath.mpf("0.3"), mpmath.mpf("0.7")
        returned, _ = midpoint(*midpoint(p, q, h), -h)
        by_name = {x.name: x for x in coefficient.free_symbols}
        value = coefficient.evalf(40, subs={by_name["p"]: p, by_name["q"]: q})
        assert abs((returned - p) / h**4 - mpmath.mpf(str(value))) < 1e-9
