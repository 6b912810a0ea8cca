"""The theorems by which the paper's statements are read otherwise: no wrong step of them passes."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import pytest

from tests.helpers.planted.theorem_controls import refused
from verify.papers import check_theorem
from verify.papers.lie_derivative_scheme import (
    consistency,
    error_measures,
    error_recursion,
    lie_series,
    lipschitz,
    matrix_vector,
    motion,
    two_norm,
)
from verify.papers.lie_derivative_scheme.criteria import (
    area_preservation,
    consequences,
    other_readings,
)
from verify.papers.lie_derivative_scheme.examples import COMPENSATED, FRICTION, TO_AND_FRO

# -- smooth consistency ---------------------------------------------------------------------------

SMOOTH = {
    "a ripple of one length": "p - h + h**{n}*sin(2*pi*p)/(2*pi)",
    "lower than the step": "p - h + h**({n} + 1)*sin(2*pi*p/h**{m})/(2*pi)",
    "another phase": "p - h + h**{n}*sin(2*pi*p/h**{m} + 1)/(2*pi)",
    "not consistent": "p - 2*h + h**{n}*sin(2*pi*p/h**{m})/(2*pi)",
    "the exact flow": "p - h",
}


@pytest.mark.left_to_ci
@pytest.mark.parametrize("ripple", SMOOTH.values(), ids=SMOOTH)
def test_a_scheme_that_satisfies_criterion_2_or_is_not_consistent_is_no_counterexample(
    ripple: str,
) -> None:
    assert refused(consistency.consistency_is_not_enough(ripple))


def test_the_growth_of_explicit_euler_is_what_the_evidence_says() -> None:
    """Λ = (1 + h²)^(T/h) − 1 by mpmath, to the digits that are told."""
    with mpmath.workdps(120):
        lam = (1 + mpmath.mpf(1) / 10**4) ** (100 * consistency.TIME) - 1
        shown = mpmath.nstr(lam, 6)
    assert shown == "7.15408e+86"
    holds, told = consistency.enclosed_growth(Fraction(1, 100))
    assert (holds, told) == (True, f"`{shown}`")
    found = check_theorem("criteria-of-consistent-schemes")
    assert shown in found.evidence
    assert shown in found.proof


# -- Eq. 1–11 -------------------------------------------------------------------------------------


def test_another_sign_in_eq_1_has_no_invariant() -> None:
    assert refused(motion.eq_1(sign=1))


@pytest.mark.parametrize(
    "formulas",
    [
        ("p**2/2 + q**2/2 + delta*q**4/4", "q + delta*q**2"),
        ("p**2/2 + q**2/2 - delta*q**4/4", "q + delta*q**3"),
        ("p**2 + q**2/2 + delta*q**4/4", "q + delta*q**3"),
    ],
)
def test_another_hamiltonian_gives_another_equation(formulas: tuple[str, str]) -> None:
    assert refused(motion.eq_17(formulas))
    assert refused(motion.eq_25(("p**2/2 + cos(q)", "sin(q)")))


def test_eq_3_as_it_is_printed_is_not_what_is_meant() -> None:
    assert refused(lie_series.eq_3_meant("p"))


@pytest.mark.parametrize("shift", [1, -1])
def test_another_order_of_the_local_error_is_not_proved(shift: int) -> None:
    assert refused(error_recursion.local_error(shift))


@pytest.mark.parametrize("formula", ["p**2/2", "p**2/2 - q", "p**2 + q"])
def test_eq_7_is_not_refuted_by_a_solution_of_another_system(formula: str) -> None:
    assert refused(error_recursion.eq_7(formula))


def test_the_triangle_inequality_notices_a_wrong_sign() -> None:
    assert refused(error_recursion.eq_8(middle_sign=-1))


def test_eq_10_with_a_steeper_line_than_the_exponential_is_not_proved() -> None:
    assert refused(error_recursion.eq_10_meant(slope=2))


def test_eq_11_with_a_factor_less_is_not_proved() -> None:
    assert refused(error_recursion.eq_11_norm(lambda rate, k: rate ** max(k - 2, 0)))


@pytest.mark.parametrize("norm", [0.1, 0.5])
def test_a_lipschitz_constant_that_is_too_small_is_not_taken(norm: float) -> None:
    assert refused(lipschitz.eq_9_plane(norm))


def test_a_norm_that_is_too_small_bounds_no_step() -> None:
    assert refused(two_norm.two_norm_of_the_step(Fraction(9, 10)))


# -- Eq. 12 and area ------------------------------------------------------------------------------


def test_a_matrix_that_is_not_the_jacobian_is_no_linear_part() -> None:
    assert refused(matrix_vector.eq_12_tangent(Fraction(1, 1000)))


def test_the_terms_of_the_step_in_h_are_not_the_identity() -> None:
    assert refused(matrix_vector.near_identity(start=1))


@pytest.mark.left_to_ci
@pytest.mark.parametrize("formula", ["p**2/2 + q**2/2", "p**2/2 + q**4/4"])
def test_a_step_that_changes_areas_is_no_example_of_criterion_1(formula: str) -> None:
    assert refused(area_preservation.area_definition(formula))
    assert refused(area_preservation.criterion_1(formula))


def test_the_identity_neither_changes_the_flow_nor_areas() -> None:
    assert refused(area_preservation.area_definition_flow(factor=1))


@pytest.mark.parametrize(
    "formulas",
    [
        ("-q", "p"),  # one-to-one
        ("(p**2 - q**2)/sqrt(p**2 + q**2)", "2*p*q/sqrt(p**2 + q**2)"),  # det J = 2
        ("p**3", "q/(3*p**2)"),  # one-to-one, and radii are not halved
    ],
)
def test_a_map_that_is_one_to_one_or_changes_areas_says_nothing_against_criterion_1(
    formulas: tuple[str, str],
) -> None:
    assert refused(area_preservation.criterion_1_any_map(formulas))


# -- Eq. 14–16 and the criteria -------------------------------------------------------------------


def test_the_determinant_of_a_truncated_flow_is_not_1() -> None:
    assert refused(error_measures.eq_14(highest=3, eta=2))


def test_a_mean_square_about_another_value_is_not_the_mse() -> None:
    assert refused(error_measures.eq_15(true=2))
    assert refused(error_measures.eq_15_sum(steps=1))


def test_the_chain_rule_notices_another_determinant() -> None:
    assert refused(error_measures.criterion_4(Fraction(1, 10**9)))


def test_criteria_2_and_3_are_not_those_of_another_field_or_map() -> None:
    assert refused(consequences.criterion_3(hamiltonian=False))
    assert refused(consequences.criterion_2(replace(FRICTION, q_next="q")))
    assert refused(consequences.criterion_3_any_map(replace(FRICTION, p_next="p - h*q")))


def test_the_smaller_lambda_is_the_worse_only_where_areas_change_more_in_each_step() -> None:
    assert refused(error_measures.smaller_lambda_each_step(FRICTION, TO_AND_FRO))
    assert refused(error_measures.smaller_lambda_each_step(COMPENSATED))


def test_maps_that_are_small_for_each_k_and_at_once_do_not_tell_the_senses_apart() -> None:
    assert refused(other_readings.criterion_2_implies_3_pointwise(COMPENSATED))
    assert refused(other_readings.criterion_2_implies_3_pointwise(FRICTION))
    assert refused(other_readings.criterion_4_and_2_pointwise(COMPENSATED))
    assert refused(other_readings.criterion_4_and_2_pointwise(alternating=[FRICTION]))
    assert refused(other_readings.criterion_4_against_2_smooth(hamiltonian=True))
    assert refused(other_readings.criterion_4_against_3_smooth(hamiltonian=True))
    planted = replace(FRICTION, p_next="p", q_next="q + h*p")
    assert refused(other_readings.criterion_4_against_3_smooth(friction=planted))
