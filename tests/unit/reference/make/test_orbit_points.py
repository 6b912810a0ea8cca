"""An orbit at chosen steps against exact rationals; the flow against closed forms."""

from fractions import Fraction

import pytest

from verify.execution.keeping import NOTHING
from verify.reference.make.tasks import OrbitTask, SolutionTask
from verify.scenes.results.reference import OrbitPoint, Rounded

H = Fraction(1, 10)
QUARTIC = "p**2/2 + q**4/4"


def lie2(p: Fraction, q: Fraction) -> tuple[Fraction, Fraction, Fraction]:
    """One step of lie2 for p²/2 + q⁴/4, and its ΔJ, by hand."""
    p_next = p - H * q**3 - H**2 / 2 * 3 * q**2 * p
    q_next = q + H * p - H**2 / 2 * q**3
    a, b = 1 - H**2 / 2 * 3 * q**2, -H * 3 * q**2 - H**2 * 3 * q * p
    c, d = H, 1 - H**2 / 2 * 3 * q**2
    return p_next, q_next, a * d - b * c - 1


def by_hand(steps: int) -> dict[str, Fraction]:
    p, q = Fraction(1, 3), Fraction(6, 5)
    squares, product = Fraction(0), Fraction(1)
    for _ in range(steps):
        p, q, change = lie2(p, q)
        squares, product = squares + change**2, product * (1 + change)
    found = {"p": p, "q": q, "delta_j": lie2(p, q)[2], "lam": product - 1}
    return found | ({"mse": squares / steps} if steps else {})


def task(scheme: str = "lie2", formula: str = QUARTIC, **more: object) -> OrbitTask:
    given = {"q": "6/5", "p": "1/3", "step_size": H, "steps": (0, 1, 2, 5), "digits": 25}
    return OrbitTask.model_validate(
        {"hamiltonian": formula, "parameters": {}, "scheme": scheme} | given | more
    )


def points(asked: OrbitTask) -> tuple[OrbitPoint, ...]:
    return asked.compute(NOTHING).points


def holds(cell: Rounded | None, value: Fraction) -> bool:
    assert cell is not None
    return abs(Fraction(cell.value) - value) <= Fraction(cell.radius)


def test_every_number_is_the_exact_one_rounded() -> None:
    for point in points(task()):
        assert (point.status, point.kind) == ("finished", "enclosed")
        for name, value in by_hand(point.step).items():
            assert holds(getattr(point, name), value), (point.step, name)
    assert points(task())[0].mse is None


def test_a_neighbouring_value_would_not_hold() -> None:
    for point in points(task()):
        for name, value in by_hand(point.step).items():
            if value:
                assert not holds(getattr(point, name), value * (1 + Fraction(1, 10**23)))


@pytest.mark.parametrize("digits", [1, 7, 60])
def test_so_many_digits_as_are_asked_for(digits: int) -> None:
    point = points(task(digits=digits))[2]
    assert point.q is not None
    assert sum(c.isdigit() for c in point.q.value.partition("e")[0]) in (digits, digits + 1)


def test_what_preserves_area_has_exact_zeros() -> None:
    zero = Rounded(value="0", radius="0")
    for point in points(task("stormer-verlet"))[1:]:
        assert (point.delta_j, point.mse, point.lam) == (zero, zero, zero)


def test_a_step_that_solves_equations_has_the_delta_j_that_is_proved() -> None:
    point = points(task("gauss4", "p**2/2 - cos(q)"))[1]
    assert point.status == "finished"
    assert point.delta_j == Rounded(value="0", radius="0")


def test_an_orbit_that_leaves_says_at_which_step() -> None:
    asked = task("lie1", "p**2/2 + q**4/4", step_size=Fraction(1000), steps=(1, 40))
    first, last = points(asked)
    assert first.status == "finished"
    assert (last.status, last.p, last.lam) == ("left range", None, None)
    assert last.failed_step is not None
    assert 2 < last.failed_step < 40


def test_an_orbit_at_rest_is_zero_to_twice_the_digits() -> None:
    asked = task("lie2", "p**2/2 + q**2/2 - q**4/4", q=1, p=0, digits=12, steps=(5,))
    (point,) = points(asked)
    assert point.p in (Rounded(value="0", radius="1e-24"), Rounded(value="0", radius="0"))
    assert holds(point.q, Fraction(1))


def flow(formula: str, **more: object) -> list[tuple[str, str | None]]:
    given = {"q": 1, "p": 0, "step_size": H, "steps": (0, 5, 30), "digits": 20}
    asked = SolutionTask.model_validate({"hamiltonian": formula, "parameters": {}} | given | more)
    found = asked.compute(NOTHING).points
    return [(x.status, x.q.value if x.q else None) for x in found]


def test_the_flow_of_an_oscillator_is_the_cosine() -> None:
    assert flow("p**2/2 + q**2/2") == [
        ("finished", "1e+00"),
        ("finished", "8.7758256189037271612e-01"),  # cos(1/2)
        ("finished", "-9.8999249660044545727e-01"),  # cos(3)
    ]


def test_a_solution_that_blows_up_says_so() -> None:
    statuses = [status for status, _ in flow("p**2/2 - q**4/4", steps=(0, 5, 3000))]
    assert statuses == ["finished", "finished", "blows up"]


def test_where_h_is_not_defined_the_solution_is_not_followed_and_at_0_it_is_the_start() -> None:
    statuses = flow("p**2/2 - log(q - 2)", steps=(0, 5))
    assert statuses == [("finished", "1e+00"), ("not followed", None)]
