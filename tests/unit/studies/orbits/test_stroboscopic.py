"""Orbits at multiples of a period: as runs have them, how far they are known, and bad input."""

from fractions import Fraction
from pathlib import Path

import pytest

from verify.errors import InputError
from verify.execution.execute import Store, execute
from verify.execution.executors import THIS_PROCESS
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.periods import check_period, is_angle
from verify.pages.sections.scene.stroboscopic import SECTION
from verify.runs.requested_run import run
from verify.scenes.results.orbit_points import StroboscopicResult
from verify.scenes.results.report import SceneResult
from verify.scenes.scene import load_scene
from verify.studies.kinds.orbits import STUDY
from verify.studies.tasks_of_scenes import plan_scenes

KICKED = "p**2/2 - (1 + 3*cos(2*pi*t)/2)*cos(q)"
LONG = 500  # periods, in which a wild orbit loses more digits than there are
SECTION_OF = """
[[stroboscopic]]
period = 1
step_size = 0.05
periods = {periods}
digits = {digits}
initial_values = [{{ q = 0.3, p = 0 }}, {{ q = 3, p = 0.2 }}]
"""


def found(
    folder: Path, periods: int = 12, digits: int = 33, hamiltonian: str = KICKED, t0: str = "1/3"
) -> StroboscopicResult:
    path = folder / "strobe.toml"
    head = f'hamiltonian = "{hamiltonian}"\nt0 = "{t0}"\nschemes = ["lie2", "stormer-verlet"]\n'
    path.write_text(head + SECTION_OF.format(periods=periods, digits=digits))
    scene = load_scene(path)
    results = execute(plan_scenes([scene]), Store(None), where=THIS_PROCESS)
    assert STUDY.results_for_scene is not None
    (result,) = STUDY.results_for_scene(scene, results)["stroboscopic"]
    assert isinstance(result, StroboscopicResult)
    assert StroboscopicResult.model_validate_json(result.model_dump_json()) == result
    return result


@pytest.mark.left_to_ci
def test_a_point_is_where_a_run_of_so_many_periods_ends(tmp_path: Path) -> None:
    result = found(tmp_path)
    for each in result.sections:
        for orbit in each.orbits:
            assert len(orbit.points) == 13
            assert orbit.points[0] == tuple(
                f"{float(x):.6e}" if Fraction(x) else "0" for x in (orbit.q, orbit.p)
            )
            for periods in (1, 7, 12):
                one = run(
                    Hamiltonian.parse(KICKED), each.scheme, q=orbit.q, p=orbit.p,
                    t0="1/3", step_size="0.05", steps=20 * periods, arithmetic="mpfr", digits=40,
                    observables=(),
                )  # fmt: skip
                for name, shown in zip("qp", orbit.points[periods], strict=True):
                    true = Fraction(one.values[name].value)
                    assert abs(Fraction(shown) - true) <= Fraction(1, 10**6) * (1 + abs(true))


@pytest.mark.left_to_ci
def test_what_more_digits_do_not_confirm_is_not_called_known(tmp_path: Path) -> None:
    """Near the saddle an orbit loses its digits; in the middle of the island it keeps them."""
    few, many = (found(tmp_path, periods=LONG, digits=digits) for digits in (17, 60))
    for coarse, fine in zip(few.sections, many.sections, strict=True):
        (calm, wild), (also_calm, clear) = coarse.orbits, fine.orbits
        assert calm.known == also_calm.known == LONG
        assert wild.known < clear.known == LONG
        assert wild.in_float64 < wild.known
        assert calm.in_float64 == LONG
        good = wild.known + 1
        size = 2 * Fraction(1, 10**6) * (1 + max(abs(Fraction(q)) for q, _ in clear.points))
        for one, other in zip(wild.points[:good], clear.points[:good], strict=True):
            assert all(
                abs(Fraction(x) - Fraction(y)) <= size for x, y in zip(one, other, strict=True)
            )
        assert wild.points[LONG] != clear.points[LONG]


@pytest.mark.left_to_ci
def test_an_orbit_that_leaves_ends_there(tmp_path: Path) -> None:
    result = found(tmp_path, hamiltonian="p**2/2 - q**4*(2 + cos(2*pi*t))", periods=40)
    for each in result.sections:
        assert each.orbits[1].left
        assert len(each.orbits[1].points) < 41


@pytest.mark.left_to_ci
def test_q_is_drawn_within_a_turn_where_it_is_an_angle(tmp_path: Path) -> None:
    assert found(tmp_path).q_is_angle
    assert not found(tmp_path, hamiltonian="p**2/2 + q**2 + q*cos(2*pi*t)").q_is_angle
    assert not is_angle(Hamiltonian.parse("p**2/2 - cos(q/2)"))


def test_without_t_the_scene_has_no_t0(tmp_path: Path) -> None:
    assert found(tmp_path, hamiltonian="p**2/2 - cos(q)").t0 is None


@pytest.mark.parametrize(
    ("hamiltonian", "period", "good"),
    [
        ("p**2/2 + q*cos(2*pi*t + 1)", "1", True),
        ("p**2/2 + q*sin(4*pi*t)", "1/2", True),
        ("p**2/2 + q*sin(2*pi*t/3)**2", "3/2", True),
        ("p**2/2 + q*cos(2*pi*t)", "1/2", False),
        ("p**2/2 + q*cos(6*t/5)", "1", False),
        ("p**2/2 + q*t", "1", False),
        ("p**2/2 + q**2", "7/5", True),
    ],
)
def test_which_h_have_a_period(hamiltonian: str, period: str, good: bool) -> None:
    exact = Hamiltonian.parse(hamiltonian)
    if good:
        check_period(exact, Fraction(period))
        return
    with pytest.raises(InputError, match=r"period=.*: H is not the same at t"):
        check_period(exact, Fraction(period))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("step_size = 0.05", "step_size = 0.03", "period=1: is no whole number of steps of 0.03"),
        ("period = 1", "period = 0.5", "H is not the same at t"),
        ("periods = 12", "periods = 20000", "periods"),
        ("periods = 12", "periods = 0", "periods"),
        ("digits = 33", "digitz = 33", "digitz"),
    ],
)
def test_bad_input_is_one_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    path = tmp_path / "bad.toml"
    text = SECTION_OF.format(periods=12, digits=33).replace(old, new)
    path.write_text(f'hamiltonian = "{KICKED}"\nschemes = ["lie2"]\n{text}')
    with pytest.raises(InputError) as error:
        load_scene(path)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_a_page_says_how_far_orbits_are_known(tmp_path: Path) -> None:
    scene = SceneResult(
        name="driven", title="", hamiltonian=KICKED, parameters={}, source="", time=None,
        proofs=(), criteria=(), runs=(), series=(),
        stroboscopic=(found(tmp_path, periods=LONG, digits=17),),
    )  # fmt: skip
    (each,) = SECTION.view(scene, "of-it")
    assert "1 of 2 orbits is known for a part of the time alone" in each.finding
    assert "float64 shows another picture from period" in each.finding
    assert len(each.rows) == 4
    assert "<svg" in each.plot.svg
