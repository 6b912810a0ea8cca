"""The page's part on orbits over two initial values says what the data say."""

from typing import Any

from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import report, run, scene
from verify.pages.page import render
from verify.scenes.results.stability import OrbitMapResult

MAP = OrbitMapResult(
    hamiltonian="p1**2/2 + p2**2/2 + q1**2*q2", parameters={}, scheme="lie2", axes=("q2", "p2"),
    across=("0", "0.5", "1"), upwards=("-1", "1"), q=("0.25", "0"), p=("0", "0"), step_size="0.1",
    steps=1000, beyond="12", every=16,
    kinds=(("regular", "sensitive", "leaves"), ("regular", "undecided", "leaves")),
    left=((None, None, 32), (None, None, 48)),
    lyapunov=(("0.01", "0.2", None), ("0.02", "0.05", None)),
    defects=(("1.00e-03", "5.00e+07", None), ("2.00e-03", "1.00e+00", None)),
    energies=(("1.0e-01", "1.5e-01", "1.7e-01"), ("1.1e-01", "1.6e-01", "1.8e-01")),
)  # fmt: skip


def page_of(*maps: OrbitMapResult) -> str:
    return render(report((scene(orbit_maps=maps),)))


def test_a_scene_that_did_not_ask_shows_nothing_of_it() -> None:
    assert "Orbits over two" not in render(report((scene(runs=(run(),)),)))


def test_kinds_are_counted_and_energies_told() -> None:
    text = text_of(page_of(MAP))
    assert "By lie2 the lowest energy that leaves is 0.17, the highest that stays 0.16." in text
    assert "6 orbits over q2 and p2, by lie2, until t = 100; h = 0.1" in text
    assert "with q1 = 0.25, p1 = 0" in text
    assert "Grey lines: the same energy H." in text


def test_where_all_stay_or_all_leave_that_is_told() -> None:
    def only(kind: Any) -> OrbitMapResult:
        return MAP.model_copy(update={"kinds": ((kind,) * 3,) * 2})

    assert "By lie2 all leave." in text_of(page_of(only("leaves")))
    assert "By lie2 none leaves." in text_of(page_of(only("regular")))


def test_of_an_h_that_depends_on_time_no_energy_is_told() -> None:
    driven = MAP.model_copy(update={"energies": ((None,) * 3,) * 2})
    text = text_of(page_of(driven))
    assert "Grey lines" not in text
    assert "energy" not in text.split("Terms")[0].split("Orbits over two")[-1]


def test_starts_that_are_no_decimals_have_their_place() -> None:
    thirds = MAP.model_copy(update={"across": ("-1/6", "0", "1/6")})
    assert "6 orbits over q2 and p2" in text_of(page_of(thirds))
