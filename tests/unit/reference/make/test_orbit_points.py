"""An orbit at chosen steps against exact rationals; the flow against closed forms."""

from fractions import Fraction
from itertools import product

import pytest

from verify.execution.keeper import NOTHING
from verify.reference.make.scene_plan import OrbitTask, SolutionTask
from verify.scenes.results.reference import OrbitPoint, Rounded

H = Fraction(1, 10)
Cells = dict[tuple[int, str], tuple[Rounded, Fraction]]
QUARTIC = "p**2/2 + q**4/4"
HEILES = "p1**2/2 + p2**2/2 + q1**2/2 + q2**2/2 + q1**2*q2 - q2**3/3"


def lie2(p: Fraction, q: Fraction) -> tuple[Fraction, Fraction, Fraction]:
    """One step of lie2 for p²/2 + q⁴/4, and its ΔJ, by hand."""
    p_next = p - H * q**3 - H**2 / 2 * 3 * q**2 * p
    q_next = q + H * p - H**2 / 2 * q**3
    a, b = 1 - H**2 / 2 * 3 * q**2, -H * 3 * q**2 - H**2 * 3 * q * p
    c, d = H, 1 - H**2 / 2 * 3 * q**2
    return p_next, q_next, a * d - b * c - 1


def in_the_plane(steps: int) -> dict[str, Fraction]:
    p, q = Fraction(1, 3), Fraction(6, 5)
    squares, volume = Fraction(0), Fraction(1)
    for _ in range(steps):
        p, q, change = lie2(p, q)
        squares, volume = squares + change**2, volume * (1 + change)
    found = {"p": p, "q": q, "delta_j": lie2(p, q)[2], "lam": volume - 1}
    return found | ({"mse": squares / steps} if steps else {})


def in_degrees(steps: int) -> dict[str, Fraction | list[Fraction]]:
    """lie1 for Hénon and Heiles: z' = z + h f, J = 1 + h A, W = MᵀΩM − Ω."""
    h = Fraction(1, 20)
    z = [Fraction(0), Fraction(1, 3), Fraction(3, 10), Fraction(1, 10)]
    one = [[Fraction(a == b) for b in range(4)] for a in range(4)]
    m, largest, volume = one, Fraction(0), Fraction(1)
    for _ in range(steps):
        p1, p2, q1, q2 = z
        f = [-(q1 + 2 * q1 * q2), -(q2 + q1**2 - q2**2), p1, p2]
        a = [[0, 0, -(1 + 2 * q2), -2 * q1], [0, 0, -2 * q1, -(1 - 2 * q2)],
             [1, 0, 0, 0], [0, 1, 0, 0]]  # fmt: skip
        j = [[one[r][c] + h * a[r][c] for c in range(4)] for r in range(4)]
        largest = max(largest, greatest(j))
        volume *= determinant(j)
        m = [[sum(j[r][k] * m[k][c] for k in range(4)) for c in range(4)] for r in range(4)]
        z = [x + h * y for x, y in zip(z, f, strict=True)]
    p1, p2, q1, q2 = z
    energy = (p1**2 + p2**2 + q1**2 + q2**2) / 2 + q1**2 * q2 - q2**3 / 3
    numbers = {"p": z[:2], "q": z[2:], "energy": energy, "symplectic_defect": greatest(m),
               "lam": volume - 1}  # fmt: skip
    return numbers | ({"symplectic_defect_max": largest} if steps else {})


def greatest(j: list[list[Fraction]]) -> Fraction:
    def entry(a: int, b: int) -> Fraction:
        own = sum((j[i][a] * j[2 + i][b] - j[2 + i][a] * j[i][b] for i in (0, 1)), Fraction(0))
        return own - ((b == a + 2) - (a == b + 2))

    return max(abs(entry(a, b)) for a, b in product(range(4), repeat=2))


def determinant(j: list[list[Fraction]]) -> Fraction:
    if len(j) == 1:
        return j[0][0]
    minors = ([row[:c] + row[c + 1 :] for row in j[1:]] for c in range(len(j)))
    return sum(((-1) ** c * j[0][c] * determinant(x) for c, x in enumerate(minors)), Fraction(0))


def task(scheme: str = "lie2", formula: str = QUARTIC, **more: object) -> OrbitTask:
    given = {"q": "6/5", "p": "1/3", "step_size": H, "steps": (0, 1, 2, 5), "digits": 25}
    return OrbitTask.model_validate(
        {"hamiltonian": formula, "parameters": {}, "scheme": scheme} | given | more
    )


def points(asked: OrbitTask) -> tuple[OrbitPoint, ...]:
    return asked.compute(NOTHING).points


def heiles() -> OrbitTask:
    start = {"q": ["0.3", "0.1"], "p": [0, "1/3"], "step_size": "1/20"}
    return task("lie1", HEILES, **start, steps=(0, 1, 20), digits=18)


def holds(cell: Rounded | None, value: Fraction) -> bool:
    assert cell is not None
    return abs(Fraction(cell.value) - value) <= Fraction(cell.radius)


@pytest.fixture(scope="module", params=[task(), heiles()], ids=["plane", "degrees"])
def orbit(request: pytest.FixtureRequest) -> OrbitTask:
    return request.param


@pytest.fixture(scope="module")
def cells(orbit: OrbitTask) -> Cells:
    """Every number by its step and name, and what it is by hand."""
    by_hand = in_the_plane if orbit.scheme == "lie2" else in_degrees
    numbers: Cells = {}
    for point in points(orbit):
        assert (point.status, point.kind) == ("finished", "enclosed")
        for name, value in by_hand(point.step).items():
            cell = getattr(point, name)
            pairs = zip(cell, value, strict=True) if isinstance(value, list) else [(cell, value)]
            numbers |= {(point.step, f"{name}{k}"): pair for k, pair in enumerate(pairs, start=1)}
    return numbers


def test_every_number_is_the_exact_one_rounded(cells: Cells) -> None:
    assert len(cells) in (4 * 4 + 3, 3 * 7 + 2)
    for place, (cell, value) in cells.items():
        assert holds(cell, value), place


def test_a_neighbouring_value_would_not_hold(orbit: OrbitTask, cells: Cells) -> None:
    off = Fraction(100, 10**orbit.digits)
    for place, (cell, value) in cells.items():
        if value:
            assert not holds(cell, value * (1 + off)), place


def test_before_the_first_step_nothing_of_steps_is_summed_up() -> None:
    assert points(task())[0].mse is None
    assert points(heiles())[0].symplectic_defect_max is None


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
