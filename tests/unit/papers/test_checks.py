"""The identities that arguments rest on: each holds, and none with a planted error in it."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from tests.helpers.planted.theorem_controls import refused
from verify.algebra.symbols import P, Q
from verify.papers import elementary_identities
from verify.papers.argument import Check, same
from verify.papers.lie_derivative_scheme import (
    determinant,
    developables,
    families,
    lipschitz,
    matrix_vector,
    two_norm,
)
from verify.papers.lie_derivative_scheme.convergence import _length_grows
from verify.papers.lie_derivative_scheme.criteria import area_preservation, connections
from verify.papers.lie_derivative_scheme.examples import (
    COMPENSATED,
    FRICTION,
    NOT_UNIFORM,
    TO_AND_FRO,
    ExampleMap,
    shrinks_to,
    turns_to_and_fro,
)

PLANTED: list[tuple[Callable[..., Check], Any]] = [
    (elementary_identities.triangle, 0),
    (elementary_identities.triangle, -1),
    (elementary_identities.difference, "ac"),
    (elementary_identities.difference, "bc"),
    (elementary_identities.product_of_determinants, -1),
    (elementary_identities.derivative_of_the_field, 1),
    (elementary_identities.derivative_at_rest, 2),
    (elementary_identities.stretching, 2),
    (elementary_identities.geometric, 1),
    (elementary_identities.bound_of_eq_11, 2),
    (elementary_identities.squares_of_times, 2),
    (elementary_identities.mean_of_fourth_powers, 4),
    (elementary_identities.compensated_changes, 1),
    (matrix_vector.euler, 1),
    (matrix_vector.stays_linear, 1),
    (developables.contraction, 2),
    (developables.legendre, -1),
    (developables.radial, 1),
    (developables.ruled_hessian, -1),
    (developables.comparison, 1),
    (families.moves_by_a_constant, "c*p**2 + d*q"),
    (families.by_acceleration, 2),
    (families.twice, 3),
    (determinant._last_coefficients, 1),
    (determinant._spirals, 2),
    (shrinks_to, 1),
    (turns_to_and_fro, -1),
    (_length_grows, 2),
]


@pytest.mark.parametrize(("check", "error"), PLANTED, ids=lambda x: getattr(x, "__name__", str(x)))
def test_an_identity_holds_and_not_with_an_error_in_it(
    check: Callable[..., Check], error: Any
) -> None:
    assert check().holds
    assert not check(error).holds


@pytest.mark.parametrize("example", [FRICTION, TO_AND_FRO, COMPENSATED, NOT_UNIFORM])
def test_the_delta_j_that_is_said_of_an_example_is_held_against_its_map(
    example: ExampleMap,
) -> None:
    assert example.changes().holds
    assert not replace(example, delta_j=f"{example.delta_j} + h**3").changes().holds


@pytest.mark.parametrize("name", ["duffing", "pendulum"])
def test_another_stretching_is_not_that_of_the_system(name: str) -> None:
    assert two_norm._stretch_of(name).holds
    assert not two_norm._stretch_of(name, "delta*q**2").holds


def test_an_h_with_a_second_derivative_does_not_decouple_the_components() -> None:
    assert refused(lipschitz.eq_9(mixed="a*p*q + b*p**2"))


def test_an_h_whose_step_has_no_such_inverse_is_no_example_of_criterion_1() -> None:
    assert refused(area_preservation.criterion_1("p**2*q"))


def test_a_run_that_does_not_cancel_is_no_example_of_a_weaker_criterion() -> None:
    assert refused(connections.criterion_4_against_2(compensated=FRICTION))


def test_formulas_are_the_same_by_algebra_and_not_by_their_text() -> None:
    assert same("x", [(P + Q) ** 2 - P**2 - 2 * P * Q - Q**2], ("p", "q")).holds
    found = same("x", [P - P, P - Q], ("p", "q"))
    assert not found.holds
    assert found.value == "`p - q`"
