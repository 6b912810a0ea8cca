"""Steps of one's own for H(p, q, t): right clocks, wrong ones, and t where it is not looked for."""

import math
from collections.abc import Callable
from typing import Any

import pytest

import verify
from tests.helpers.programs import henon_steps
from tests.helpers.programs.blind import blind
from verify.errors import InputError
from verify.flows.extrapolation import NumericalFlow
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.integrators.results import Finding
from verify.verdict import Verdict

Step = Callable[..., Any]
DRIVEN = "p**2/2 - (1 + cos(2*t)/2)*cos(q)"


def force(q: Any, t: Any) -> Any:
    return -(1 + math.cos(2 * t) / 2) * math.sin(q)


def verlet_at(first: float, last: float) -> Step:
    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        p = p + h / 2 * force(q, t + first * h)
        q = q + h * p
        return p + h / 2 * force(q, t + last * h), q

    return step


def rk4_at(middle: float, last: float) -> Step:
    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        def slope(p: Any, q: Any, t: Any) -> Any:
            return force(q, t), p

        a = slope(p, q, t)
        b = slope(p + h / 2 * a[0], q + h / 2 * a[1], t + middle * h)
        c = slope(p + h / 2 * b[0], q + h / 2 * b[1], t + middle * h)
        d = slope(p + h * c[0], q + h * c[1], t + last * h)
        return tuple(x + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) for i, x in enumerate((p, q)))

    return step


def euler(p: Any, q: Any, t: Any, h: Any) -> Any:
    p = p + h * force(q, t)
    return p, q + h * p


def four_stages_of_yoshida(late: float) -> Step:
    c = 2 ** (1 / 3)
    w, v = 1 / (2 - c), -c / (2 - c)

    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        for size in (w, v, w):
            q = q + size / 2 * h * p
            t = t + size / 2 * h * late
            p = p + size * h * force(q, t)
            q = q + size / 2 * h * p
            t = t + size / 2 * h * late
        return p, q

    return step


def checked(step: Step, system: str = DRIVEN, **claims: Any) -> Finding:
    found = verify.check(system, step, **claims)
    assert isinstance(found, Finding)
    return found


RIGHT = {
    "symplectic Euler": (euler, 1, DRIVEN),
    "Störmer–Verlet": (verlet_at(0, 1), 2, DRIVEN),
    "a midpoint's clock": (verlet_at(0.5, 0.5), 2, DRIVEN),
    "RK4": (rk4_at(0.5, 1), 4, DRIVEN),
    "arrays": (henon_steps.driven_at(0, 1), 2, henon_steps.DRIVEN),
    "arrays, one kick": (henon_steps.one_kick_at(0.5), 2, henon_steps.DRIVEN),
}
WRONG = {
    "a frozen clock": (verlet_at(0, 0), 2, "read at t in every stage"),
    "the end's time in both": (verlet_at(1, 1), 2, "read at t + h in every stage"),
    "RK4, all at the start": (rk4_at(0, 0), 4, "read at t in every stage"),
    "RK4, all at the end": (rk4_at(1, 1), 4, ""),
    "the end's time at the middle": (rk4_at(0.5, 0.5), 4, ""),
}
SAMPLED = [pytest.param(name, marks=pytest.mark.sample(2)) for name in list(RIGHT)[:4]]
IN_CI = pytest.mark.left_to_ci


@pytest.mark.parametrize("name", [*SAMPLED, "arrays"])
def test_a_right_clock_is_proved_at_its_order(name: str) -> None:
    step, order, system = RIGHT[name]
    found = checked(step, system, order=order)
    assert (found.verdict, found.how, found.convergence_order) == (Verdict.PROVED, "proof", order)
    assert (found.area_preserving, found.symplectic) == (name != "RK4", name != "RK4")
    assert not any("stands still" in str(note) for note in found.notes)


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_clock_is_refuted_at_its_order_and_named(name: str) -> None:
    step, claimed, words = WRONG[name]
    found = checked(step, order=claimed)
    assert (found.verdict, found.convergence_order) == (Verdict.REFUTED, 1)
    named = [str(note) for note in found.notes if "stands still" in str(note)]
    assert len(named) == bool(words)
    assert all(words in each and f"of order {claimed}" in each for each in named)


@pytest.mark.parametrize(("late", "order"), [(1, 4), (0, 1)])
def test_yoshidas_coefficients_are_floats_and_its_clock_is_judged(late: int, order: int) -> None:
    found = checked(four_stages_of_yoshida(late))
    assert found.convergence_order == order
    assert found.verdict.holds


def test_the_same_step_with_its_force_still_is_of_its_order_for_an_h_without_t() -> None:
    """The control: what is wrong is the clock alone."""

    def still(p: Any, q: Any, t: Any, h: Any) -> Any:
        p = p - h / 2 * math.sin(q)
        q = q + h * p
        return p - h / 2 * math.sin(q), q

    found = checked(still, "pendulum", order=2, area_preserving=True)
    assert found.verdict is Verdict.PROVED
    assert "called with t = 0" in " ".join(map(str, found.notes))


def test_a_step_without_t_is_told_that_its_force_stands_still() -> None:
    found = checked(lambda p, q, h: verlet_at(0, 0)(p, q, 0.0, h))
    assert found.verdict is Verdict.REFUTED
    assert "takes no t, and H depends on it" in " ".join(map(str, found.notes))


@pytest.mark.parametrize("swapped", [False, True])
def test_t_is_known_by_its_name_wherever_it_stands(swapped: bool) -> None:
    right = verlet_at(0, 1)

    def first(t: Any, q: Any, p: Any, dt: Any) -> Any:
        return tuple(right(p, q, t, dt))[::-1]

    def last(p: Any, q: Any, h: Any, time: Any) -> Any:
        return right(p, q, time, h)

    found = checked(first if swapped else last)
    assert (found.verdict, found.convergence_order) == (Verdict.PROVED, 2)
    named = verify.check(DRIVEN, lambda a, b, c, d: right(a, b, c, d), arguments="p,q,t,h")
    assert isinstance(named, Finding)
    assert named.convergence_order == 2
    with pytest.raises(InputError, match="nor of p, q, t and h"):
        verify.check(DRIVEN, right, arguments="p,q,t")


def solved(middle: float) -> Step:
    """The implicit midpoint rule by iteration, ended by a comparison: for dual numbers."""

    def step(p: Any, q: Any, t: Any, h: Any) -> Any:
        x, y = p, q
        for _ in range(200):
            u = p + h * force((q + y) / 2, t + middle * h)
            v = q + h * (p + x) / 2
            moved = abs(u - x) + abs(v - y)
            x, y = u, v
            if moved == 0:
                break
        return x, y

    return step


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("how", ["duals", "floats"])
@pytest.mark.parametrize(
    ("middle", "order", "words"),
    [(0.5, 2, ""), (0.0, 1, "read at t in every stage"), (1.0, 1, "read at t + h in every stage")],
)
def test_what_cannot_be_traced_is_measured_and_its_clock_is_named(
    how: str, middle: float, order: int, words: str
) -> None:
    step = solved(middle)
    found = checked(blind(step) if how == "floats" else step, order=2)
    assert found.how == how
    assert found.convergence_order == order
    assert found.verdict is (Verdict.REFUTED if words else Verdict.MEASURED)
    named = [str(note) for note in found.notes if "stands still" in str(note)]
    assert len(named) == bool(words)
    assert all(words in each and "of order 2" in each for each in named)
    assert (found.counterexample is not None) is bool(words)
    assert any("≤ t ≤" in text for text in found.domain)


@pytest.mark.parametrize("name", [*SAMPLED, pytest.param("arrays, one kick", marks=IN_CI)])
def test_in_floats_a_right_clock_is_measured_at_its_order(name: str) -> None:
    step, order, system = RIGHT[name]
    found = checked(blind(step), system, order=order)
    assert (found.verdict, found.how) == (Verdict.MEASURED, "floats")
    assert (found.convergence_order, found.area_preserving) == (order, name != "RK4")


@pytest.mark.parametrize(
    ("step", "claimed", "words", "system"),
    [
        *(
            pytest.param(*WRONG[name], DRIVEN, marks=pytest.mark.sample(2), id=name)
            for name in WRONG
        ),
        pytest.param(
            henon_steps.one_kick_at(0), 2, "", henon_steps.DRIVEN, marks=IN_CI, id="arrays"
        ),
    ],
)
def test_in_floats_a_wrong_clock_is_refuted_at_its_order(
    step: Step, claimed: int, words: str, system: str
) -> None:
    found = checked(blind(step), system, order=claimed)
    assert (found.verdict, found.how, found.convergence_order) == (Verdict.REFUTED, "floats", 1)
    assert sum("stands still" in str(note) for note in found.notes) == bool(words)


def test_a_refuted_clock_has_a_counterexample_with_its_time() -> None:
    found = checked(verlet_at(0, 0), order=2)
    example = found.counterexample
    assert example is not None
    assert f"t = {example.t}" in str(example)
    gap = float(example.found)
    at = [float(x) for x in (*example.z.values(), example.t, example.h)]
    flow = NumericalFlow(canonical_field(Hamiltonian.parse(DRIVEN))[0], 20)
    end = flow.advance(
        tuple(map(flow.number, (*example.z.values(), example.t))), flow.number(example.h)
    )
    made = verlet_at(0, 0)(*at)
    k = "pq".index(example.quantity.partition("distance of ")[2][0])
    assert abs(float(end[k]) - made[k]) == pytest.approx(gap)


def test_branches_are_judged_at_the_points_that_are_named() -> None:
    """Where they part at a t that is reached, it is told by what is measured."""

    def branching(least: float) -> Step:
        def step(p: Any, q: Any, t: Any, h: Any) -> Any:
            return verlet_at(0, 1)(p, q, t, h) if t > least else verlet_at(0, 0)(p, q, t, h)

        return step

    assert checked(branching(0.0), order=2).verdict is Verdict.MEASURED
    assert checked(branching(0.4), order=2).verdict is Verdict.REFUTED


def test_another_branch_with_floats_is_not_taken_for_what_is_traced() -> None:
    """It does with floats what it does not with symbols."""

    def sly(p: Any, q: Any, t: Any, h: Any) -> Any:
        return verlet_at(0, 0 if type(t) is float else 1)(p, q, t, h)

    found = checked(sly, order=2)
    assert (found.verdict, found.how, found.convergence_order) == (Verdict.REFUTED, "floats", 1)
