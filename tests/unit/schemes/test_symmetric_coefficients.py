"""Which coefficients show that a step of −h undoes a step of h, in time and without it."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
import sympy

from tests.helpers.symmetry import prove_symmetry
from verify import schemes
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.splitting_conditions import Splitting
from verify.schemes.conditions.symmetric_coefficients import is_symmetric
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.methods.runge_kutta.gauss4 import TABLEAU as GAUSS4
from verify.verdict import Verdict

R, HALF = sympy.Rational, Fraction(1, 2)


@pytest.mark.parametrize("name", schemes.names())
def test_the_schemes_that_claim_it_are_shown_symmetric_and_no_others(name: str) -> None:
    scheme = schemes.get(name)
    assert is_symmetric(scheme.every_h, timed=False) is scheme.symmetric
    assert is_symmetric(scheme.every_h, timed=True) is scheme.symmetric
    assert (prove_symmetry(scheme).verdict is Verdict.PROVED) is scheme.symmetric


def test_a_scheme_without_coefficients_is_not_shown() -> None:
    assert not is_symmetric(None, timed=False)


# -- splittings -----------------------------------------------------------------------------------


def parts(name: str) -> tuple[Any, ...]:
    every_h = schemes.get(name).every_h
    assert isinstance(every_h, Splitting)
    return every_h.raw_parts


@pytest.mark.parametrize("place", range(len(parts("yoshida4"))))
def test_a_part_of_another_size_is_seen(place: int) -> None:
    planted = list(parts("yoshida4"))
    kind, size = planted[place]
    planted[place] = kind, size + R(1, 10**30)
    middle = place == len(planted) // 2
    assert is_symmetric(Splitting(tuple(planted)), timed=False) is middle


def test_a_part_of_the_other_kind_is_seen() -> None:
    verlet = [("kick", HALF), ("drift", Fraction(1)), ("kick", HALF)]
    assert is_symmetric(Splitting(tuple(verlet)), timed=False)
    verlet[2] = "drift", HALF
    assert not is_symmetric(Splitting(tuple(verlet)), timed=False)


@pytest.mark.parametrize(
    ("times", "symmetric"),
    [((0, R(1, 2), 1), True), ((None, None, None), True), ((R(1, 3), R(1, 2), R(2, 3)), True),
     ((0, R(1, 2), 0), False), ((1, 1, 1), False), ((0, R(1, 3), 1), False)],
)  # fmt: skip
def test_times_are_mirrored_in_the_step_s_middle(times: Any, symmetric: bool) -> None:
    split = Splitting(parts("stormer-verlet"), tuple(map(sympy.sympify, times)))
    assert is_symmetric(split, timed=True) is symmetric
    assert is_symmetric(split, timed=False)  # without time they are not read


# -- tableaux -------------------------------------------------------------------------------------


@pytest.mark.parametrize("row", [0, 1, 2])
@pytest.mark.parametrize("column", [0, 1])
def test_each_changed_coefficient_of_a_tableau_is_seen(row: int, column: int) -> None:
    rows = [list(x) for x in (*GAUSS4.rows, GAUSS4.weights)]
    assert is_symmetric(TreeConditions(ImplicitTableau.from_numbers(rows[:2], rows[2])), timed=True)
    rows[row][column] += sympy.sqrt(3) / 10**20
    planted = ImplicitTableau.from_numbers(rows[:2], rows[2])
    assert not is_symmetric(TreeConditions(planted), timed=False)


def test_both_tableaux_of_a_partitioned_method_count() -> None:
    lobatto_a = ImplicitTableau.from_numbers([[0, 0], [R(1, 2), R(1, 2)]], [R(1, 2)] * 2)
    lobatto_b = ImplicitTableau.from_numbers([[R(1, 2), 0], [R(1, 2), 0]], [R(1, 2)] * 2)
    assert is_symmetric(TreeConditions(replace(lobatto_a, of_q=lobatto_b)), timed=False)
    left = ImplicitTableau.from_numbers([[0, 0], [R(1, 2), 0]], [R(1, 2)] * 2)
    assert not is_symmetric(TreeConditions(replace(lobatto_a, of_q=left)), timed=False)


def test_in_time_the_weights_add_up_to_one() -> None:
    long = ImplicitTableau.from_numbers([[1]], [2])  # a_11 + a_11 = b_1
    assert is_symmetric(TreeConditions(long), timed=False)
    assert not is_symmetric(TreeConditions(long), timed=True)


@pytest.mark.parametrize(("time", "symmetric"), [(R(1, 2), True), (0, False), (None, True)])
def test_the_clock_of_a_tableau_counts(time: Any, symmetric: bool) -> None:
    midpoint = ImplicitTableau.from_numbers([[R(1, 2)]], [1]).with_times([time])
    assert is_symmetric(TreeConditions(midpoint), timed=True) is symmetric


# -- stages one after the other -------------------------------------------------------------------


def stage(kick: Any, drift: Any, at_p: Any, at_q: Any) -> Stage:
    return Stage(*map(Fraction, (kick, drift, at_p, at_q)))


@pytest.mark.parametrize(
    ("stages", "still", "timed"),
    [
        ([stage(1, 1, HALF, HALF)], True, True),
        ([stage(1, 1, 1, 0)], False, False),
        ([stage(1, 1, HALF, 0)], False, False),
        # Symplectic Euler and its adjoint; the clocks of both are those of q.
        ([stage(HALF, HALF, 1, 0), stage(HALF, HALF, 0, 1)], True, True),
        ([stage(HALF, HALF, 1, 0), stage(HALF, HALF, 1, 0)], False, False),
        ([stage(HALF, HALF, 1, 0), stage(HALF, Fraction(1, 3), 0, 1)], False, False),
        # A share of nothing does not count, but q's is the clock.
        ([stage(HALF, 0, HALF, 0), stage(0, 1, 0, HALF), stage(HALF, 0, HALF, 0)], True, False),
        ([stage(HALF, 0, HALF, 0), stage(0, 1, 0, HALF), stage(HALF, 0, HALF, 1)], True, True),
    ],
)  # fmt: skip
def test_stages_are_mirrored_with_their_shares(
    stages: list[Stage], still: bool, timed: bool
) -> None:
    equations = StageEquations(tuple(stages))
    assert is_symmetric(equations, timed=False) is still
    assert is_symmetric(equations, timed=True) is timed
