"""The page's part on the growth law says what the data say, and only where it was asked for."""

from typing import Any

import pytest

from tests.helpers.constructed.growth import LOST, TWO, of, prediction
from tests.helpers.pages.imported_modules import imported_by
from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.test_page import EVIL, Reader, proof, report, run, scene
from verify.pages.page import render
from verify.scenes.results.growth import GrowthLawResult


def page_of(*laws: GrowthLawResult, **changes: Any) -> str:
    return render(report((scene(growth_laws=laws, **changes),)))


def text_of(page: str) -> str:
    return " ".join("".join(Reader(page).texts).replace("\xa0", " ").split())


def test_a_scene_that_did_not_ask_shows_nothing_of_it() -> None:
    assert "rowth law" not in render(report((scene(runs=(run(),)),)))


@pytest.mark.parametrize(
    ("made", "absent"),
    [
        ("scene(runs=(run(),))", {"verify.pages.figures.step_size_figures"}),
        ("scene(growth_laws=(LOST,))", {"verify.pages.figures.step_size_figures", "matplotlib"}),
    ],
)
def test_what_is_not_shown_is_not_imported(made: str, absent: set[str]) -> None:
    assert not absent & imported_by(
        "from tests.helpers.constructed.growth import LOST", f"render(report(({made},)))"
    )


def test_the_law_stands_with_its_orders_and_the_worst_difference_is_told() -> None:
    text = text_of(page_of(TWO))
    assert "log(1 + Λ) = h² [G] + h³ (T ⟨g⟩ + [B − ½ X G]) + a remainder" in text
    assert (
        "Over the 2 runs, predicted and measured Λ differ by at most 0.005 of Λ (at h = 0.02)"
        in text
    )
    assert "and by at most 0.25 h of it" in text
    assert "The bounded part is 10 % as large as the secular one" in text
    assert "libration, P = 6.283, ⟨g⟩ = 2.500 × 10⁻¹" in text
    assert "estimated (once more)" in text


def test_without_a_potential_the_law_says_that_nothing_telescopes() -> None:
    plain = {"power": 1, "potential": "", "telescopes": False, "by_potential": False}
    text = text_of(page_of(of(prediction("0.01"), g="cos(q)", **plain)))
    assert "log(1 + Λ) = h (T ⟨g⟩ + [B]) + a remainder" in text
    assert "does not telescope" in text
    assert "[G]" not in text


def test_what_it_explains_is_said_only_where_the_scene_says_so() -> None:
    assert "That is the pattern" not in text_of(page_of(TWO))
    assert "That is the pattern in Figure 7" in text_of(page_of(TWO, growth_explains="Figure 7"))


def test_an_orbit_without_an_average_says_why() -> None:
    text = text_of(page_of(TWO, LOST))
    assert "on a separatrix" in text
    assert "Of 2 initial values, 1 has no known average" in text
    assert "no known average" not in text_of(page_of(TWO))


def test_a_scheme_without_a_law_says_so_and_claims_no_rate() -> None:
    none = of(power=0, g="", potential="", orbit="undecided", reason="it is undecided",
              average=None, period=None)  # fmt: skip
    text = text_of(page_of(none))
    assert "There is no growth law: it is undecided." in text
    assert "h⁰" not in text


def test_the_figure_has_both_panels_and_an_orbit_each() -> None:
    other = of(prediction("0.01"), prediction("0.02"), q="0.5")
    (svg,) = figures(page_of(TWO, other))
    shown = "".join(svg.itertext())
    assert "(a) |Λ|" in shown
    assert "(b) |predicted − measured|" in shown
    assert "∝ h" in shown
    assert shown.count("q₀") == 2


def test_one_step_size_or_an_unknown_difference_is_not_drawn() -> None:
    assert figures(page_of(of(prediction("0.01")))) == []
    assert figures(page_of(of(prediction("0.01"), prediction("0.02", None)))) == []
    assert figures(page_of(of(prediction("0.01"), prediction("0.02", "0")))) == []


def test_more_orbits_than_styles_are_drawn_without_a_legend() -> None:
    many = [of(*TWO.predictions, q=str(n)) for n in range(12)]
    (svg,) = figures(page_of(*many))
    assert "q₀" not in "".join(svg.itertext())


def test_what_others_wrote_stays_text() -> None:
    evil = of(*TWO.predictions, scheme=EVIL, error_method=EVIL, g=EVIL, potential=EVIL)
    lost = of(scheme=EVIL, reason=EVIL, average=None, period=None, orbit="undecided")
    page = page_of(evil, lost, proofs=(proof(scheme=EVIL),), growth_explains=EVIL)
    assert EVIL not in page
