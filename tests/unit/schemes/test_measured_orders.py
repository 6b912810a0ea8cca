"""Orders of convergence measured against the exact flow, for every scheme there is.

With 60 digits rounding is no limit, so that h can be small enough for the leading term alone.
What measuring cannot see, a coefficient that is off by 10⁻¹¹, the exact conditions do; see
test_splitting_conditions.py.
"""

import math
from fractions import Fraction

import pytest
import sympy

from tests.helpers.planted.splittings import with_error, with_hidden_error
from tests.helpers.stepping.stepper import Stepper
from verify import schemes
from verify.arithmetic.arb import slope
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_conditions import prove_by_conditions
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

SYSTEMS = {"duffing": "p**2/2 + q**2/2 + q**4/4", "pendulum": "p**2/2 - cos(q)"}
STEPS = (80, 100, 125, 160, 200)
START = {"p": Fraction(2, 5), "q": Fraction(6, 5), "time": Fraction(3, 2)}
FLOOR = 1e-40  # of what is measured, far above 60 digits' rounding
WITHIN = 0.1


def measured(scheme: Scheme, system: str) -> float:
    """The slope of the error over the step size; InputError for an H that it does not take."""
    stepper = Stepper(scheme.step_map(Hamiltonian.parse(SYSTEMS[system])))
    errors = [stepper.error(steps=n, **START) for n in STEPS]
    assert min(errors) > FLOOR
    points = [(-math.log(n), math.log(e)) for n, e in zip(STEPS, errors, strict=True)]
    return slope(points)[0]


@pytest.mark.sample(10)
@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("name", schemes.names())
def test_the_measured_order_is_the_claimed_one(name: str, system: str) -> None:
    scheme = schemes.get(name)
    try:
        found = measured(scheme, system)
    except InputError:
        assert not scheme.explicit
        pytest.skip(f"{name} does not take {system}")
    assert abs(found - scheme.order) < WITHIN


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize(("name", "other"), [("lie3", 2), ("ruth3", 4), ("suzuki4", 3)])
def test_another_order_is_refuted_by_what_is_measured(name: str, other: int, system: str) -> None:
    assert abs(measured(schemes.get(name), system) - other) > 5 * WITHIN


@pytest.mark.parametrize("name", ["ruth3", "yoshida4", "blanes-moan4", "triple-jump6"])
def test_a_large_error_in_a_coefficient_is_measured(name: str) -> None:
    wrong = with_error(name, 1, sympy.Rational(1, 1000))
    assert measured(wrong, "duffing") < 1 + WITHIN


def test_an_error_of_ten_to_the_minus_11_is_proved_where_it_cannot_be_measured() -> None:
    wrong = with_hidden_error("suzuki4", sympy.Rational(1, 10**11))
    assert wrong is not None
    assert abs(measured(wrong, "duffing") - 4) < WITHIN
    assert prove_by_conditions(wrong, wrong.every_h).verdict is Verdict.REFUTED
