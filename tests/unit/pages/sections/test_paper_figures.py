"""The paper's figures made again: each drawn once, with its claims."""

import re

from tests.helpers.constructed.flows import EULER, THREE, TWO
from tests.unit.pages.figures.test_figures import figures
from tests.unit.pages.sections.test_flow_view import page_of
from tests.unit.pages.sections.test_growth_view import text_of
from tests.unit.pages.test_page import Reader, claim, proof, report, run, scene
from verify.pages.page import render
from verify.scenes.paper_sections import PaperFigure
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.report import Report
from verify.scenes.results.run import SeriesPoint
from verify.verdict import Verdict

SERIES = tuple(
    SeriesPoint(first=i, last=i, delta_j=("-1e-9", "1e-9"), lam=("0", "1e-9")) for i in range(1, 9)
)


def paper() -> Report:
    """Three figures, of runs, a series and a flow, and one more series that is in none of them."""
    lam = {h: Value(value=f"{h}e-05", bound="1e-10") for h in ("0.01", "0.02")}
    mine = scene(
        proofs=(proof(),),
        runs=tuple(run(step_size=h, values={"lambda": value}) for h, value in lam.items()),
        series=(
            run(series=SERIES, source="Figure 2"), run(series=SERIES, q="2", source="Figure 9"),
        ),
        flows=(TWO.model_copy(update={"source": "Figure 3"}), THREE),
    )  # fmt: skip
    return report(
        (mine,),
        claims=(
            claim(id="grows", statement="It grows."),
            claim(id="kept", statement="It keeps area.", verdict=Verdict.REFUTED, evidence="by 42"),
        ),
        figures=(
            PaperFigure(label="Figure 1", caption="Errors.", scene="mine", shows="runs",
                        claims=("grows",), assumed="T = 20,000."),
            PaperFigure(label="Figure 2", scene="mine", shows="series"),
            PaperFigure(label="Figure 3", scene="mine", shows="flow", claims=("kept",)),
        ),
    )  # fmt: skip


def article(page: str, anchor: str) -> str:
    (found,) = re.findall(
        rf'<article class="made-again \w+" id="{anchor}".*?</article>', page, re.DOTALL
    )
    return str(found)


def test_every_figure_is_drawn_once_and_those_of_the_paper_in_their_order() -> None:
    page = render(paper())
    labels = [svg.get("aria-label") for svg in figures(page)]
    assert len(labels) == len(set(labels)) == 5, "runs, two series, two flows"
    assert re.findall(r'class="made-again \w+" id="([^"]*)"', page) == [
        "figure-1", "figure-2", "figure-3",
    ]  # fmt: skip
    assert 'href="#figures"' in page
    telling = 'href="#telling"'
    assert telling in article(page, "figure-1"), "it stands on the first screen"
    assert "<svg" in article(page, "figure-2")
    assert "<svg" in article(page, "figure-3")
    for anchor in ("figure-2", "figure-3"):
        assert page.count(f'<p class="jump">Drawn in <a href="#{anchor}">') == 1, "in its scene"


def test_a_figure_has_its_claims_with_their_verdicts_and_what_was_assumed() -> None:
    page = render(paper())
    first, second, third = (text_of(article(page, f"figure-{i}")) for i in (1, 2, 3))
    assert "“Errors.”" in first
    assert "What the paper draws from it ✓ PROVED It grows." in first
    assert "Assumed. T = 20,000." in first
    assert "The paper draws nothing from it that a number can decide." in second
    assert "✗ REFUTED It keeps area." in third
    assert 'href="#claim-kept"' in article(page, "figure-3")
    assert "lie2 with h = 0.01, N = 300 changes the area of the circle by 9.8765 × 10⁻⁴" in third


def test_the_page_with_figures_is_well_formed_and_its_links_lead_somewhere() -> None:
    reader = Reader(render(paper()))
    ids = reader.all("id")
    assert len(ids) == len(set(ids))
    assert all(t == "results.json" or t.removeprefix("#") in ids for t in reader.all("href"))


def test_a_figure_of_which_nothing_was_computed_says_so() -> None:
    alone = PaperFigure(label="Figure 7", scene="mine", shows="flow", claims=("unknown",))
    gone = alone.model_copy(update={"label": "Figure 8", "scene": "other"})
    page = render(report((scene(),), figures=(alone, gone)))
    assert page.count("Nothing of it was computed.") == 2


def test_a_report_without_figures_has_no_section_of_them() -> None:
    assert 'id="figures"' not in page_of(TWO)
    assert EULER["map"] in page_of(THREE)
