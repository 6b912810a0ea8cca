"""The page's figures: inline, themed, told apart without colour, and nothing left behind."""

import math
import re
from typing import Any
from xml.etree import ElementTree

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from tests.unit.pages.test_page import page_of, real
from verify.pages.figures.axes import set_decade_ticks
from verify.pages.figures.over_time_figure import merge_buckets
from verify.pages.page import render
from verify.scenes.results.run import SeriesPoint


def figures(page: str) -> list[Any]:
    found = re.findall(r"<svg.*?</svg>", page, re.DOTALL)
    return [ElementTree.fromstring(svg) for svg in found]  # noqa: S314 - our own page


def test_figures_are_inline_images_that_follow_the_theme() -> None:
    found = figures(page_of("real"))
    assert len(found) == 3, "the table, |Λ| and MSE/|Λ| over h, one series"
    ids = [e.get("id") for svg in found for e in svg.iter() if e.get("id")]
    assert ids
    assert len(ids) == len(set(ids))
    for svg in found:
        assert svg.get("role") == "img"
        assert svg.get("aria-label") == svg[0].text
        assert svg[0].tag == "title"
        assert "viewBox" in svg.attrib
        assert not {"width", "height"} & set(svg.attrib)
        texts = [e for e in svg.iter() if e.tag == "text"]
        assert texts
        assert all(e.get("fill") == "currentColor" for e in texts)
        assert not [e for e in svg.iter() if e.tag in ("style", "metadata", "image")]
        own = {e.get("id") for e in svg.iter()}
        for e in svg.iter():
            for target in (e.get("href", "#"), e.get("clip-path", "url(#)")[4:-1]):
                assert target == "#" or target[1:] in own


def test_lines_differ_by_more_than_colour() -> None:
    plot = figures(page_of("real"))[1]
    lines = [e for e in plot.iter() if e.get("style", "").startswith("stroke: var(--series")]
    assert len({e.get("style") for e in lines}) == 2
    assert len({e.get("stroke-dasharray") for e in lines if e.tag == "path"}) == 2


def test_drawing_leaves_matplotlib_as_it_was() -> None:
    with mpl.rc_context({"font.size": 7, "svg.fonttype": "path"}):
        before = dict(mpl.rcParams)
        render(real())
        assert dict(mpl.rcParams) == before


def test_neighbouring_buckets_are_put_together_with_their_extremes() -> None:
    points = [
        SeriesPoint(first=i, last=i, delta_j=(f"-{i}e-9", f"{i}e-9"), lam=("0", str(i)))
        for i in range(1, 6)
    ]
    assert merge_buckets(points, 5) == points
    whole = merge_buckets(points, 1)
    assert whole == [SeriesPoint(first=1, last=5, delta_j=("-5e-9", "5e-9"), lam=("0", "5"))]


@pytest.mark.parametrize(
    ("low", "high"),
    [(-7.0, 3.0), (-1.7, -0.9), (-2.2, -2.0), (-400.5, -400.1), (-3.77, -3.72), (-3.7745, -3.7744)],
)
def test_a_tick_of_a_logarithmic_axis_says_where_it_stands(low: float, high: float) -> None:
    axes = Figure().subplots()
    axes.set_ylim(low, high)
    set_decade_ticks(axes.yaxis)
    axes.figure.canvas.draw()
    digits = {ord(a): b for a, b in zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-", strict=True)}
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert len(set(labels)) == len(labels) >= 2
    for place, label in zip(axes.get_yticks(), labels, strict=True):
        mantissa, _, power = label.rpartition("10")
        said = math.log10(float(mantissa.rstrip("·") or "1")) + int(power.translate(digits))
        assert said == pytest.approx(place, abs=1e-7)


@pytest.mark.sample(2)
@pytest.mark.parametrize("source", ["Table $\\frac$ 9", "$a_b$", "T\x01\x00", "<b>T</b> & 9"])
def test_a_source_stays_text_in_a_figure(source: str) -> None:
    made = real()
    claims = tuple(
        c.model_copy(update={"source": source}) if c.id == "table-9" else c for c in made.claims
    )
    shown = source.replace("\x01", "\ufffd").replace("\x00", "\ufffd")
    first = figures(render(made.model_copy(update={"claims": claims})))[0]
    assert f"printed: {shown}" in [e.text for e in first.iter() if e.tag == "text"]
    assert first.get("aria-label", "").startswith(shown)


def test_a_numbers_own_blanks_stay_in_legends_and_text_alternatives() -> None:
    assert "\ufffd" not in page_of("real")
    assert "q₀\xa0=\xa01, p₀\xa0=\xa00</text>" in page_of("real")
