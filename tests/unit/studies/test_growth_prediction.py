"""The growth law of Λ: what it says for known systems, and what is predicted of a run."""

from fractions import Fraction
from typing import Any

import mpmath
import pytest

from verify.algebra.formula import symbol
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.plane.growth_law import NoLawError, growth_law
from verify.runs.requested_run import run
from verify.scenes.results.growth import AverageResult
from verify.scenes.results.run import RunResult
from verify.studies.growth_prediction import compute_average, predict_runs

PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
SKEW = Hamiltonian.parse("p**2/2 + q**2/2 + q**3/5 + p*q**2/4 + p**4/8")


def shown(element: tuple[Any, Any] | None) -> str:
    assert element is not None
    ring, x = element
    return str(ring.as_product(x))


def ran(hamiltonian: Hamiltonian, scheme: str, **changes: Any) -> RunResult:
    asked = {"q": "1.5", "p": 0, "step_size": "0.01", "steps": 1000, **changes}
    return run(hamiltonian, scheme, **asked)


def mean(hamiltonian: Hamiltonian, scheme: str, **changes: Any) -> AverageResult:
    return compute_average(hamiltonian, scheme, **{"q": "1.5", "p": 0, "digits": 12, **changes})


# -- the law --------------------------------------------------------------------------------------


def test_the_pendulums_law_is_that_of_eq_29() -> None:
    """ΔJ = −h³/2 p sin q + h⁴/4 cos² q."""
    law = growth_law(PENDULUM, "lie2")
    assert law.power == 3
    assert shown(law.potential) == "cos(q)/2"
    assert shown(law.leading) == "-p*sin(q)/2"
    assert shown(law.g) == "cos(q)**2/4"


@pytest.mark.parametrize(("scheme", "power"), [("lie2", 3), ("lie4", 5), ("lie6", 7)])
def test_for_even_eta_the_leading_coefficient_is_the_derivative_of_the_potential(
    scheme: str, power: int
) -> None:
    law, (field, _) = growth_law(SKEW, scheme), canonical_field(SKEW)
    assert law.power == power
    assert law.potential is not None
    assert law.leading is not None
    derivative = field.ring.expression(field.derive(law.potential[1]))
    assert (derivative - law.leading[0].expression(law.leading[1])).expand() == 0


@pytest.mark.parametrize(("scheme", "power"), [("lie1", 1), ("lie3", 3), ("lie5", 5)])
def test_for_odd_eta_there_is_no_potential_and_g_is_the_leading_coefficient(
    scheme: str, power: int
) -> None:
    law = growth_law(SKEW, scheme)
    assert (law.power, law.potential, law.leading) == (power, None, None)


def test_the_law_of_lie1_has_the_determinant_of_the_hessian() -> None:
    ring, g = growth_law(SKEW, "lie1").g
    p, q = symbol("p"), symbol("q")
    a, b, d = (SKEW.exact.diff(x, y) for x, y in ((p, p), (p, q), (q, q)))
    assert (ring.expression(g) - (a * d - b * b)).expand() == 0


def test_a_scheme_of_another_kind_has_the_law_of_its_leading_coefficient() -> None:
    """Explicit Euler by formulas is lie1, and has its law."""
    euler = growth_law(PENDULUM, "p_next = p - h*sin(q); q_next = q + h*p")
    assert shown(euler.g) == shown(growth_law(PENDULUM, "lie1").g) == "cos(q)"
    assert euler.power == 1


def test_what_preserves_area_or_is_no_scheme_has_no_law() -> None:
    with pytest.raises(NoLawError, match="exactly 0"):
        growth_law(PENDULUM, "symplectic-euler")
    with pytest.raises(NoLawError, match="not consistent"):
        growth_law(PENDULUM, "p_next = p - h*p; q_next = q")
    with pytest.raises(InputError, match="no value"):
        growth_law(Hamiltonian.parse("p**2/2 + a*q**4"), "lie2")


# -- averages as results --------------------------------------------------------------------------


def test_an_average_says_what_it_is_of_and_how_it_is_known() -> None:
    found = mean(PENDULUM, "lie2", digits=30)
    assert (found.orbit, found.error_kind, found.reason) == ("libration", "estimated", "")
    assert (found.g, found.potential, found.power) == ("cos(q)**2/4", "cos(q)/2", 3)
    assert found.average is not None
    with mpmath.workdps(40):
        k = mpmath.sin(mpmath.mpf(3) / 4)
        m, K, E = k**2, mpmath.ellipk(k**2), mpmath.ellipe(k**2)
        square, fourth = (K - E) / (m * K), ((2 + m) * K - 2 * (1 + m) * E) / (3 * m**2 * K)
        true = (1 - 4 * m * square + 4 * m**2 * fourth) / 4
        gap = abs(mpmath.mpf(found.average.value) - true)
        assert gap <= mpmath.mpf(found.average.bound) < 1e-29


def test_at_an_equilibrium_the_average_is_the_value_there_and_is_enclosed() -> None:
    found = mean(PENDULUM, "lie2", q=0)
    assert (found.orbit, found.error_kind, found.period) == ("equilibrium", "enclosed", None)
    assert found.average is not None
    assert (Fraction(found.average.value), found.average.bound) == (Fraction(1, 4), "0")


@pytest.mark.parametrize(
    ("hamiltonian", "scheme", "at", "reason"),
    [
        (PENDULUM, "lie2", {"q": 0, "p": 2}, "separatrix"),
        (Hamiltonian.parse("p**2/2 - q**4"), "lie2", {}, "far away"),
        (PENDULUM, "symplectic-euler", {}, "exactly 0"),
    ],
    ids=["separatrix", "unbounded", "no-law"],
)
def test_where_there_is_no_average_there_is_a_reason_and_nothing_is_predicted(
    hamiltonian: Hamiltonian, scheme: str, at: dict[str, Any], reason: str
) -> None:
    found = mean(hamiltonian, scheme, **at)
    assert (found.orbit, found.average, found.period) == ("undecided", None, None)
    assert reason in found.reason
    result = ran(hamiltonian, scheme, steps=5, **at)
    assert predict_runs(hamiltonian, found, [result]) == ()


@pytest.mark.parametrize("digits", [0, 201, True, 1.5])
def test_digits_out_of_reach_are_refused(digits: Any) -> None:
    with pytest.raises(InputError, match="digits"):
        mean(PENDULUM, "lie2", digits=digits)


def test_an_average_is_the_same_after_a_round_trip_through_json() -> None:
    found = mean(PENDULUM, "lie2")
    assert AverageResult.model_validate_json(found.model_dump_json()) == found


# -- predictions ----------------------------------------------------------------------------------


def test_the_parts_add_up_to_the_logarithm_of_what_is_predicted() -> None:
    result = ran(PENDULUM, "lie2")
    (found,) = predict_runs(PENDULUM, mean(PENDULUM, "lie2"), [result])
    total = mpmath.mpf(found.boundary.value) + mpmath.mpf(found.secular.value)
    assert mpmath.expm1(total) == pytest.approx(float(found.predicted.value), rel=1e-9)
    assert found.measured == result.values["lambda"]
    assert found.difference is not None
    gap = float(found.predicted.value) / float(found.measured.value) - 1
    assert gap == pytest.approx(float(found.difference.value), rel=1e-3)
    assert abs(gap) < 0.01


def test_runs_without_an_end_point_or_without_lambda_are_left_out() -> None:
    whole, average = ran(PENDULUM, "lie2"), mean(PENDULUM, "lie2")
    for name in ("p", "q", "lambda"):
        values = {n: v for n, v in whole.values.items() if n != name}
        assert predict_runs(PENDULUM, average, [whole.model_copy(update={"values": values})]) == ()
    assert len(predict_runs(PENDULUM, average, [whole, whole])) == 2


def test_at_an_equilibrium_only_the_secular_part_is_left() -> None:
    """Λ = (1 + h⁴/4)^N − 1, predicted as exp(N h⁴/4) − 1."""
    result = ran(PENDULUM, "lie2", q=0, step_size="0.1", steps=10_000)
    (found,) = predict_runs(PENDULUM, mean(PENDULUM, "lie2", q=0), [result])
    assert float(found.boundary.value) == 0
    assert float(found.secular.value) == pytest.approx(0.25, rel=1e-12)
    assert float(found.measured.value) == pytest.approx((1 + 1e-4 / 4) ** 10_000 - 1, rel=1e-9)
    assert found.difference is not None
    assert 0 < float(found.difference.value) < 1e-4


def test_where_the_run_left_the_orbit_the_difference_says_so_and_nothing_breaks() -> None:
    """lie1 gains energy without end: at h T = 20 its law is far from what it was proved for."""
    result = ran(PENDULUM, "lie1", q="0.5", step_size="0.04", steps=12_500)
    (found,) = predict_runs(PENDULUM, mean(PENDULUM, "lie1", q="0.5"), [result])
    assert found.difference is not None
    assert abs(float(found.difference.value)) > 1


def test_on_a_quadratic_hamiltonian_the_law_is_that_of_the_closed_form() -> None:
    """lie2 on the harmonic oscillator: ΔJ = h⁴/4 everywhere."""
    harmonic = Hamiltonian.parse("p**2/2 + q**2/2")
    result = ran(harmonic, "lie2", steps=1000, digits=17, arithmetic="mpfr")
    (found,) = predict_runs(harmonic, mean(harmonic, "lie2"), [result])
    h, steps = mpmath.mpf("0.01"), 1000
    assert float(found.boundary.value) == 0
    assert float(found.secular.value) == pytest.approx(float(steps * h**4 / 4), rel=1e-12)
