"""∮ p·dq in n degrees of freedom: exact values, Stokes' theorem, symplectic maps; wrong ones."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from click.testing import CliRunner

import verify
from verify.commands.main import cli
from verify.flows.points import exact_points
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.systems import get
from verify.scenes.region_sections import PlacedShape
from verify.scenes.results.regions import EXACT_FLOW, FlowImage
from verify.studies.regions import mean_lambda as mean_module
from verify.studies.regions import point_carriers
from verify.studies.regions.carry import carry
from verify.studies.regions.place import Place

COUPLED = Hamiltonian.parse("p1**2/2 + p2**2/2 + q1**2 + 3*q2**2/2 + q1*q2/2 + p1*q2/3")
HENON_HEILES = get("henon-heiles").hamiltonian({})
POINT = {"p1": Fraction(2, 5), "p2": Fraction(0), "q1": Fraction(0), "q2": Fraction(1, 10)}
N, H = 6, Fraction(1, 10)


def carried(
    scheme: str = "lie2", hamiltonian: Hamiltonian = HENON_HEILES, shape: str = "circle",
    plane: int = 1, steps: int = N, h: Fraction = H, digits: int = 17, mean: bool = True,
) -> FlowImage:  # fmt: skip
    place = Place.from_point(POINT, plane)
    q, p = POINT[f"q{plane}"], POINT[f"p{plane}"]
    put = PlacedShape(shape=shape, centre={"q": q, "p": p}, scale=Fraction(1, 10))  # type: ignore[arg-type]
    return carry(
        hamiltonian, scheme, put.to_shape(), step_size=h, steps=steps, digits=digits,
        mean_lambda=mean, distance=False, place=place,
    )  # fmt: skip


def number(text: str | None) -> Fraction:
    assert text is not None
    return Fraction(text)


def is_sharp(image: FlowImage, times: int = 100) -> bool:
    return number(image.probe_error) * times <= abs(number(image.area_change))


def exact_matrix() -> list[list[Fraction]]:
    """M of lie2 on the coupled oscillators, (1 + hA + h²A²/2)^N in rationals; p1, p2, q1, q2."""
    third, half = Fraction(1, 3), Fraction(1, 2)
    a = [  # z' = A z
        [Fraction(0), Fraction(0), Fraction(-2), -half],
        [-third, Fraction(0), -half, Fraction(-3)],
        [Fraction(1), Fraction(0), Fraction(0), third],
        [Fraction(0), Fraction(1), Fraction(0), Fraction(0)],
    ]
    one = [[Fraction(int(i == j)) for j in range(4)] for i in range(4)]
    square = product(a, a)
    step = [
        [one[i][j] + H * a[i][j] + H * H / 2 * square[i][j] for j in range(4)] for i in range(4)
    ]
    made = one
    for _ in range(N):
        made = product(step, made)
    return made


def product(x: list[list[Fraction]], y: list[list[Fraction]]) -> list[list[Fraction]]:
    columns = list(zip(*y, strict=True))
    return [
        [sum((a * b for a, b in zip(row, c, strict=True)), Fraction(0)) for c in columns]
        for row in x
    ]


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("plane", [1, 2])
@pytest.mark.parametrize("digits", [17, 40])
def test_a_linear_map_changes_it_by_what_its_matrix_says(plane: int, digits: int) -> None:
    """The area of each projection is a minor of M, and ∮ p·dq their sum."""
    m = exact_matrix()
    i, j = plane - 1, plane + 1
    minors = [m[k][i] * m[k + 2][j] - m[k][j] * m[k + 2][i] for k in (0, 1)]
    image = carried(hamiltonian=COUPLED, plane=plane, digits=digits)
    assert is_sharp(image)
    assert abs(number(image.area_change) - (sum(minors) - 1)) <= number(image.probe_error)
    assert abs(number(image.mean_defect) - (sum(minors) - 1)) <= number(image.mean_defect_error)
    assert image.agree
    for seen, minor in zip(image.outlines[0].projections, minors, strict=True):
        assert abs(Fraction(seen.area) - minor) <= Fraction(seen.area_error) < Fraction(1, 10**9)


@pytest.mark.parametrize("scheme", ["stormer-verlet", "implicit-midpoint", EXACT_FLOW])
def test_a_symplectic_map_keeps_it_within_the_error(scheme: str) -> None:
    image = carried(scheme)
    assert image.area_preserving
    assert abs(number(image.area_change)) <= number(image.probe_error) < Fraction(1, 10**9)
    assert image.mean_defect is None
    shares = [Fraction(x.area) for x in image.outlines[0].projections]
    assert abs(sum(shares) - 1) < Fraction(1, 10**8)
    assert abs(shares[1]) > Fraction(1, 10**4)  # it is the sum that is kept


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("scheme", ["lie2", "lie3", "rk4"])
def test_the_change_is_the_mean_of_the_defect(scheme: str) -> None:
    """The target: lie2 in Hénon–Heiles, a cat in (q1, p1), a hundred times above the error."""
    image = carried(scheme, shape="cat", steps=20)
    assert image.area_preserving is False
    assert is_sharp(image)
    allowed = number(image.probe_error) + number(image.mean_defect_error)
    assert abs(number(image.area_change) - number(image.mean_defect)) <= allowed
    assert allowed * 100 < abs(number(image.mean_defect))
    assert image.agree


def test_in_the_other_plane_too_and_from_more_digits() -> None:
    image = carried(plane=2, digits=30, steps=20)
    assert image.arithmetic != "float64"
    assert is_sharp(image, 10_000)
    assert image.agree


def test_a_wrong_defect_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = mean_module.PointMap

    class Planted(right):  # type: ignore[misc, valid-type]
        def __call__(self, **points: Any) -> Any:
            found = super().__call__(**points)
            return {**found, "w_0_2": found["w_0_2"] * (1 + 1e-5)}

    monkeypatch.setattr(mean_module, "PointMap", Planted)
    assert carried(steps=20).agree is False


def test_the_defect_of_another_plane_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = mean_module.PointMap

    class Planted(right):  # type: ignore[misc, valid-type]
        def __call__(self, **points: Any) -> Any:
            found = super().__call__(**points)
            return {**found, "w_0_2": found["w_1_3"]}

    monkeypatch.setattr(mean_module, "PointMap", Planted)
    assert carried(steps=20).agree is False


def test_a_curve_that_is_carried_wrongly_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """One momentum is off by 10⁻⁶ of itself: no picture shows it."""
    right = point_carriers._apply_map

    def planted(point_map: Any, place: Any, points: Any) -> Any:
        q1, q2, p1, p2 = right(point_map, place, points)
        return q1, q2, p1 * (1 + 1e-6), p2

    monkeypatch.setattr(point_carriers, "_apply_map", planted)
    assert carried(steps=20).agree is False


def test_an_area_that_is_kept_is_not_by_a_wrong_flow(monkeypatch: pytest.MonkeyPatch) -> None:
    """The control of the exact flow's 0: what is not symplectic is measured as such."""
    right = exact_points

    def planted(*given: Any) -> Any:
        found = right(*given)
        moved = {**found.points, "p2": found.points["p2"] * (1 + 1e-6)}
        return replace(found, points=moved)

    monkeypatch.setattr(point_carriers, "exact_points", planted)
    image = carried(EXACT_FLOW)
    assert abs(number(image.area_change)) > number(image.probe_error)


# -- from Python and in one line ------------------------------------------------------------------


def test_a_call_takes_lists_and_a_plane() -> None:
    found = verify.flow(
        "henon-heiles", "lie2", centre=([0, "1/10"], ["2/5", 0]), plane=2, scale="1/10",
        step_size=H, steps=N, exact=False,
    )  # fmt: skip
    assert found.centre == ("0.1", "0")
    assert (found.plane, found.point["p1"]) == (2, "0.4")
    assert found.images[0].agree
    assert found.images[0].area_change == carried(plane=2).area_change


def test_the_command_takes_them_too() -> None:
    asked = "flow --system henon-heiles --scheme lie2 --q 0,1/10 --p 2/5,0 --scale 1/10 --plane 1"
    result = CliRunner().invoke(cli, [*asked.split(), "--step-size", "1/10", "--steps", str(N)])
    assert result.exit_code == 0
    assert "circle at (q1, p1) = (0, 0.4), scale 0.1, p2 = 0, q2 = 0.1" in result.output
    assert "∮ p·dq changes by" in result.output
    assert "NOT THE SAME" not in result.output
