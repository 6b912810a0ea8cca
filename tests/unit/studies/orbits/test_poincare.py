"""Poincaré sections: where they are known exactly, how far they are known, and bad input."""

from collections.abc import Sequence
from fractions import Fraction
from math import asin, cos, pi, sin, sqrt
from pathlib import Path
from typing import Any

import pytest

from verify.errors import InputError
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.systems import get
from verify.pages.sections.scene.poincare import SECTION
from verify.scenes.results.orbit_points import MapSections, PoincareResult
from verify.scenes.results.regions import EXACT_FLOW
from verify.scenes.results.report import SceneResult
from verify.scenes.scene import load_scene
from verify.studies import section_points
from verify.studies.kinds.orbits import STUDY
from verify.studies.section_points import SectionRequest, sections_at_surface
from verify.studies.surface_passes import (
    Surface,
    count_agreeing,
    find_passes_of_exact_flow,
    find_passes_of_scheme,
)
from verify.studies.tasks_of_scenes import plan_scenes

OSCILLATORS = Hamiltonian.parse("(p1**2 + q1**2)/2 + p2**2/2 + q2**2")
HENON_HEILES = get("henon-heiles").hamiltonian({})
NAMES = ("p1", "p2", "q1", "q2")
RISING = Surface(NAMES, "q1", Fraction(0), rising=True)
CALM = dict(zip(NAMES, (Fraction(2, 5), Fraction(0), Fraction(0), Fraction(1, 10)), strict=True))
WILD = dict(zip(NAMES, (Fraction(9, 20), Fraction(0), Fraction(0), Fraction(-1, 5)), strict=True))
ESCAPES = dict(zip(NAMES, (Fraction(1), Fraction(1), Fraction(0), Fraction(0)), strict=True))
H = Fraction(1, 10)


def made(
    name: str, *starts: Any, of: Hamiltonian = HENON_HEILES, surface: Surface = RISING,
    steps: int = 500, digits: int = 25, h: Fraction = H,
) -> MapSections:  # fmt: skip
    return sections_at_surface(
        SectionRequest(of, surface, ("q2", "p2"), h, steps, digits), name, starts
    )


@pytest.mark.parametrize(("rising", "value"), [(True, 0), (False, 0), (True, Fraction(1, 4))])
def test_the_exact_flow_passes_where_algebra_says(rising: bool, value: Fraction) -> None:
    """Two oscillators of frequencies 1 and √2: q1 = 2/5 sin t."""
    surface = Surface(NAMES, "q1", Fraction(value), rising)
    found = made(EXACT_FLOW, CALM, of=OSCILLATORS, surface=surface)
    (orbit,) = found.orbits
    assert orbit.known == len(orbit.points)
    assert Fraction(orbit.error) < Fraction(1, 10**14)
    first = asin(float(value) / 0.4) if rising else pi - asin(float(value) / 0.4)
    times = [t for t in (first + 2 * pi * k for k in range(9)) if 0 < t <= 50]
    assert len(orbit.points) == len(times)
    for (q2, p2), t in zip(orbit.points, times, strict=True):
        assert float(q2) == pytest.approx(cos(sqrt(2) * t) / 10, abs=1e-7)
        assert float(p2) == pytest.approx(-sqrt(2) * sin(sqrt(2) * t) / 10, abs=1e-7)


def test_a_scheme_passes_on_the_surface_by_a_step_of_its_own() -> None:
    given = {"step_size": H, "steps": 100, "digits": 30}
    passes = find_passes_of_scheme(OSCILLATORS, "lie2", CALM, RISING, **given)  # type: ignore[arg-type]
    assert len(passes.states) == 1
    assert not passes.left
    (state,) = passes.states
    assert abs(state["q1"]) < Fraction(1, 10**26)
    z = CALM
    for _ in range(62):  # 2π is between 62 and 63 steps
        z = lie2(z, H)
    low, high = Fraction(0), H
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if lie2(z, middle)["q1"] < 0 else (low, middle)
    for name, x in lie2(z, low).items():
        assert abs(state[name] - x) < Fraction(1, 10**15)


def lie2(z: Any, h: Fraction) -> dict[str, Fraction]:
    """A step on the oscillators, in rationals with 40 digits."""
    half = h * h / 2
    after = {
        "p1": z["p1"] * (1 - half) - h * z["q1"], "q1": z["q1"] * (1 - half) + h * z["p1"],
        "p2": z["p2"] * (1 - 2 * half) - 2 * h * z["q2"],
        "q2": z["q2"] * (1 - 2 * half) + h * z["p2"],
    }  # fmt: skip
    return {name: Fraction(round(x * 10**40), 10**40) for name, x in after.items()}


@pytest.mark.left_to_ci
def test_a_scheme_of_small_error_passes_where_the_exact_flow_does() -> None:
    exact, near = (made(name, CALM, steps=200) for name in (EXACT_FLOW, "gauss6"))
    far = made("lie2", CALM, steps=200)
    orbits = (x.orbits[0].points for x in (exact, near, far))
    for one, other, another in zip(*orbits, strict=False):  # lie2's comes by once more
        for x, y, z in zip(one, other, another, strict=True):
            assert abs(float(x) - float(y)) < 1e-6
            assert abs(float(x) - float(z)) > 1e-6


def test_points_downwards_are_others() -> None:
    falling = Surface(NAMES, "q1", Fraction(0), rising=False)
    for name in (EXACT_FLOW, "stormer-verlet"):
        up, down = (made(name, CALM, surface=x).orbits[0].points for x in (RISING, falling))
        assert abs(len(up) - len(down)) <= 1
        assert not set(up) & set(down)


def test_what_a_second_reckoning_does_not_confirm_is_not_called_known() -> None:
    few, many = (made("stormer-verlet", CALM, WILD, steps=3000, digits=d) for d in (12, 60))
    calm, wild = few.orbits
    assert calm.known == len(calm.points)
    assert wild.known < len(wild.points)
    clear = many.orbits[1]
    assert clear.known == len(clear.points)
    for one, other in zip(wild.points[: wild.known], clear.points, strict=False):
        for x, y in zip(one, other, strict=True):
            assert abs(Fraction(x) - Fraction(y)) <= Fraction(4, 10**6)


@pytest.mark.parametrize(
    ("again", "known", "apart"),
    [
        ((1, 2, 3), 3, 0),
        ((1, 2), 2, 0),
        ((), 0, 0),
        ((1, 2, 3, 4), 3, 0),
        ((1, Fraction(21, 10), 3), 3, Fraction(1, 10)),
        ((1, 2, 4), 2, 0),
        ((1, Fraction(23, 10), 3), 1, 0),
    ],
)
def test_passes_are_known_as_far_as_both_reckonings_have_them(
    again: Sequence[Fraction], known: int, apart: Fraction
) -> None:
    one, other = ([{"q": Fraction(x)} for x in xs] for xs in ((1, 2, 3), again))
    assert count_agreeing(one, other, Fraction(1, 5)) == (known, apart)


def test_a_pass_elsewhere_is_no_longer_the_same_point(monkeypatch: pytest.MonkeyPatch) -> None:
    """The control of `known`: a second reckoning that is off by 10⁻⁵ confirms nothing."""
    right, calls = find_passes_of_exact_flow, iter(range(2))

    def planted(h: Any, starts: Any, surface: Surface, *rest: Any) -> Any:
        off = Fraction(next(calls), 10**5)
        return right(h, starts, Surface(surface.names, "q1", off, rising=True), *rest)

    monkeypatch.setattr(section_points, "find_passes_of_exact_flow", planted)
    assert made(EXACT_FLOW, CALM).orbits[0].known == 0


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("name", [EXACT_FLOW, "lie2", "stormer-verlet"])
def test_an_orbit_that_leaves_ends_there_and_others_do_not(name: str) -> None:
    calm, gone = made(name, CALM, ESCAPES).orbits
    assert gone.left
    assert not calm.left
    assert len(calm.points) == (8 if name == "lie2" else 7)
    assert float(gone.energy) == 1


# -- through a scene --------------------------------------------------------------------------

SCENE = """
system = "henon-heiles"
schemes = ["lie2"]

[[poincare]]
step_size = 0.1
time = 60
digits = 20
initial_values = [{ q = [0, 0.1], p = [0.4, 0] }, { q = [0, 0], p = [0.5, 0] }]
"""


def found(folder: Path) -> PoincareResult:
    path = folder / "sections.toml"
    path.write_text(SCENE)
    scene = load_scene(path)
    results = execute(plan_scenes([scene]), Store(None), where=THIS_PROCESS)
    assert STUDY.results_for_scene is not None
    (result,) = STUDY.results_for_scene(scene, results)["poincare"]
    assert isinstance(result, PoincareResult)
    assert PoincareResult.model_validate_json(result.model_dump_json()) == result
    return result


def test_a_scene_has_each_map_and_a_page_draws_them(tmp_path: Path) -> None:
    result = found(tmp_path)
    assert [each.map for each in result.sections] == [EXACT_FLOW, "lie2"]
    assert (result.coordinate, result.value, result.rising) == ("q1", "0", True)
    for each in result.sections:
        assert [orbit.energy for orbit in each.orbits] == ["8.466666667e-02", "1.250000000e-01"]
        assert all(len(orbit.points) in (9, 10) for orbit in each.orbits)
    scene = SceneResult(
        name="sections", title="", hamiltonian="", parameters={}, source="", time=None,
        proofs=(), criteria=(), runs=(), series=(), poincare=(result,),
    )  # fmt: skip
    (view,) = SECTION.view(scene, "of-it")
    assert len(view.rows) == 4
    assert "every point is known within" in view.finding
    assert "<svg" in view.plot.svg
    assert "2 orbits where q1 passes 0 upwards" in view.title


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"henon-heiles"', '"duffing"\nparameters = { delta = 1 }', "degree of freedom"),
        ('"henon-heiles"', '"driven-henon-heiles"\nparameters = { epsilon = 1, omega = 1 }',
         "depends on t"),
        ("time = 60", "time = 60\nsteps = 3", "give one of the two"),
        ("time = 60", "time = 10000000", "more than 2000000 in all"),
        ("time = 60", 'time = 60\ncoordinate = "q3"', "coordinate=q3: is no coordinate; allowed:"),
        ("time = 60", 'time = 60\ndraw = ["q2", "x"]', "draw=x: is no coordinate"),
        ("time = 60", 'time = 60\ndraw = ["q2", "q2"]', "one of them stands twice"),
        ("[0, 0.1]", "[0]", "q=0: has 1 of 2 numbers"),
        ("rising", "rizing", ""),
    ],
)  # fmt: skip
def test_bad_input_is_one_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(SCENE.replace(old, new) if old in SCENE else f"{SCENE}{new} = true\n")
    with pytest.raises(InputError) as error:
        load_scene(path)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
