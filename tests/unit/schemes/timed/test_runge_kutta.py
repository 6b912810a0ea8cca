"""Orders of Runge–Kutta methods with stage times, held against series of steps in fractions."""

import random
from fractions import Fraction

import pytest
import sympy

from tests.helpers.stepping.steps_in_time import agreement, flow, problem, runge_kutta_step
from verify.errors import InputError
from verify.proof.order_conditions import agreed_order
from verify.schemes import get
from verify.schemes.conditions.coloured_trees import all_trees, equation_text, unrestricted_grammar
from verify.schemes.conditions.every_hamiltonian import Stage, StageEquations
from verify.schemes.conditions.implicit_tableau import ImplicitTableau
from verify.schemes.conditions.scheme_clocks import conditions_for
from verify.schemes.conditions.tree_conditions import TreeConditions
from verify.schemes.conditions.words.words import Kinetic

R, F = sympy.Rational, Fraction
TIMED = unrestricted_grammar(1, timed=True)
CLASSES = {None: "any", Kinetic.GENERAL: "general", Kinetic.MASS: "mass",
           Kinetic.QUADRATIC: "quadratic", Kinetic.AUTONOMOUS: "autonomous"}  # fmt: skip
TABLEAUS = {
    "heun": ([[0, 0], [1, 0]], [R(1, 2), R(1, 2)]),
    "kutta3": ([[0, 0, 0], [R(1, 2), 0, 0], [-1, 2, 0]], [R(1, 6), R(2, 3), R(1, 6)]),
    "rk4": ([[0] * 4, [R(1, 2), 0, 0, 0], [0, R(1, 2), 0, 0], [0, 0, 1, 0]],
            [R(1, 6), R(1, 3), R(1, 3), R(1, 6)]),
    "radau": ([[R(5, 12), R(-1, 12)], [R(3, 4), R(1, 4)]], [R(3, 4), R(1, 4)]),
    "midpoint": ([[R(1, 2)]], [1]),
    "two midpoints": ([[R(1, 4), 0], [R(1, 2), R(1, 4)]], [R(1, 2), R(1, 2)]),
}  # fmt: skip


def fractions(row) -> list[Fraction]:
    return [F(str(x)) for x in row]


def drawn(seed: int):
    """A tableau and stage times, some of whose moments are those of the right ones."""
    dice = random.Random(seed)  # noqa: S311
    rows, weights = TABLEAUS[dice.choice(sorted(TABLEAUS))]
    clock = [R(sum(row)) for row in rows]
    if dice.random() < 0.8:
        moves = [R(dice.randint(-3, 3), dice.choice((2, 4, 5))) for _ in rows]
        if dice.random() < 0.6:  # Σ b c stays as it is
            others = sum(b * x for b, x in zip(weights[1:], moves[1:], strict=True))
            moves[0] = -R(others) / weights[0]
        clock = [c + x for c, x in zip(clock, moves, strict=True)]
    return rows, weights, clock


def by_series(rows, weights, clock, kind: str, most: int) -> int:
    exact = [fractions(row) for row in rows], fractions(weights), fractions(clock)
    points = (problem(seed, kind) for seed in (1, 2, 3))
    return min(agreement(runge_kutta_step(x, *exact, most), flow(x, most)) for x in points)


@pytest.mark.left_to_ci
@pytest.mark.sample(6)
@pytest.mark.parametrize("seed", range(20))
def test_the_order_is_that_of_the_steps_series(seed: int) -> None:
    rows, weights, clock = drawn(seed)
    tableau, most = ImplicitTableau.from_numbers(rows, weights).with_times(clock), 4
    for kinetic in (None, Kinetic.MASS, Kinetic.QUADRATIC):
        found, _ = agreed_order(TreeConditions(tableau, kinetic), most - 2)
        assert found == by_series(rows, weights, clock, CLASSES[kinetic], most), kinetic


def test_samples_have_several_orders() -> None:
    found = set()
    for seed in range(20):
        rows, weights, clock = drawn(seed)
        tableau = ImplicitTableau.from_numbers(rows, weights).with_times(clock)
        found.add(agreed_order(TreeConditions(tableau), 2)[0])
    assert {1, 2, 3, 4} <= found


@pytest.mark.parametrize("name", ["rk4", "gauss4", "gauss6", "implicit-midpoint",
                                  "explicit-midpoint"])  # fmt: skip
def test_right_clocks_keep_the_order_and_frozen_ones_leave_1(name: str) -> None:
    scheme = get(name)
    for kinetic in CLASSES:
        right = conditions_for(scheme.every_h, kinetic)
        assert agreed_order(right, scheme.order)[0] == scheme.order
        stages = right.tableau.stages
        frozen = conditions_for(scheme.every_h, kinetic, [sympy.S.Zero] * stages)
        order, wrong = agreed_order(frozen, scheme.order)
        assert (order, wrong.name, float(wrong.residue)) == (1, "b·t = 1/2", -0.5)


@pytest.mark.parametrize("name", ["rk4", "gauss4", "gauss6"])
def test_with_right_clocks_each_tree_with_leaves_of_time_holds(name: str) -> None:
    """What the argument says, tree by tree."""
    scheme = get(name)
    numbers = conditions_for(scheme.every_h).tableau.numbers
    weights = numbers.tree_weights
    for n in range(1, scheme.order + 1):
        assert all(numbers.ring.decide(weights.gap(t)).zero for t in all_trees(TIMED, n))
    assert not all(
        numbers.ring.decide(weights.gap(t)).zero for t in all_trees(TIMED, scheme.order + 1)
    )


def test_one_stage_of_the_wrong_time_is_refuted_with_its_residue() -> None:
    rows, weights = TABLEAUS["rk4"]
    clock = [0, R(1, 2), R(1, 2), 1 + R(1, 10**6)]
    tableau = ImplicitTableau.from_numbers(rows, weights).with_times(clock)
    order, wrong = agreed_order(TreeConditions(tableau), 4)
    assert (order, wrong.name, wrong.residue) == (1, "b·t = 1/2", "1.6667e-07")


def test_stages_of_two_parts_are_those_of_symplectic_euler() -> None:
    euler = conditions_for(get("implicit-symplectic-euler").every_h)
    assert len(euler.tableau.parts) == 2
    assert agreed_order(euler, 2)[0] == 1
    assert all(c.holds for c in euler.area_conditions())
    half, one = F(1, 2), F(1)
    halves = StageEquations((Stage(half, half, at_p=one), Stage(half, half, at_q=one)))
    verlet = conditions_for(halves)  # Störmer–Verlet for every H: p implicit, then q
    assert agreed_order(verlet, 2)[0] == 2
    assert all(c.holds for c in verlet.area_conditions())
    assert agreed_order(conditions_for(halves, None, [R(0), R(1)]), 2)[0] == 2
    order, wrong = agreed_order(conditions_for(halves, None, [R(0), R(0)]), 2)
    assert (order, wrong.name) == (1, "b_p·t = 1/2")


def test_conditions_are_written_with_t_for_the_stages_times() -> None:
    assert [equation_text(t, ("",)) for t in all_trees(TIMED, 3)] == [
        "b·A(t) = 1/6", "b·A(c) = 1/6", "b·t^2 = 1/3", "b·(t c) = 1/3", "b·c^2 = 1/3",
    ]  # fmt: skip


def test_bad_input_is_refused() -> None:
    tableau = ImplicitTableau.from_numbers([[R(1, 2)]], [1])
    with pytest.raises(ValueError, match="as many stages"):
        tableau.with_times([0, 1])
    with pytest.raises(InputError, match="up to 8"):
        TreeConditions(tableau.with_times([0])).order_conditions(9)
