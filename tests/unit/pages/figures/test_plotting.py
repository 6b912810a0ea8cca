"""The figures as matplotlib's: labelled, restyled by whoever asks, the same as on the page."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from tests.helpers.constructed.flows import FAILED, THREE, flow
from tests.helpers.constructed.growth import TWO
from tests.helpers.constructed.separations import CROSSING, grid
from tests.helpers.constructed.stability import MAP
from tests.helpers.constructed.work import ladder, result
from tests.unit.pages.test_page import claim, real, run
from verify.errors import InputError
from verify.pages import plotting
from verify.scenes.results.separation import SeparationGrid
from verify.studies.separation.truncation_and_rounding import as_grid

SCENE = real().scenes[0]
RUNS = [r for r in SCENE.runs if r.scheme == "lie2"]
TABLE = next(c for c in real().claims if c.id == "table-9")
MAKERS: dict[str, Callable[[], Figure]] = {
    "runs": lambda: plotting.plot_runs(RUNS, slopes=(2, 3)),
    "mse": lambda: plotting.plot_runs(RUNS, "mse"),
    "over time": lambda: plotting.plot_over_time(SCENE.series[0]),
    "separation": lambda: plotting.plot_separation(CROSSING),
    "table": lambda: plotting.plot_table(TABLE),
    "growth": lambda: plotting.plot_growth([TWO]),
    "work precision": lambda: plotting.plot_work_precision(result(ladder())),
    "stability": lambda: plotting.plot_stability(MAP),
    "flow": lambda: plotting.plot_flow(THREE),
}


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", MAKERS)
def test_a_figure_has_labelled_axes_and_shows_itself(name: str) -> None:
    figure = MAKERS[name]()
    assert isinstance(figure, Figure)
    assert figure.get_facecolor()[:3] == (1.0, 1.0, 1.0)
    assert all(axes.get_ylabel() for axes in figure.axes)
    assert figure.axes[-1].get_xlabel()
    shown: Any = figure
    assert shown._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", ["runs", "separation", "table"])
def test_its_legend_names_every_line(name: str) -> None:
    figure = MAKERS[name]()
    (legend,) = figure.legends
    labels = [text.get_text() for text in legend.get_texts()]
    drawn = [line.get_label() for line in figure.axes[0].get_lines()]
    assert labels == [label for label in drawn if not str(label).startswith("_")]
    assert len(labels) >= 2


def test_the_points_are_those_of_the_runs() -> None:
    figure = plotting.plot_runs(RUNS)
    line = figure.axes[0].get_lines()[0]
    first = sorted((r for r in RUNS if r.q == "1"), key=lambda r: Fraction(r.step_size))
    assert [10**x for x in line.get_xdata()] == pytest.approx([float(r.step_size) for r in first])
    wanted = [abs(float(r.values["lambda"].value)) for r in first]
    assert [10**y for y in line.get_ydata()] == pytest.approx(wanted, rel=1e-9)


def test_schemes_have_lines_of_their_own() -> None:
    both = [r.model_copy(update={"scheme": name}) for r in RUNS for name in ("lie2", "lie4")]
    labels = [line.get_label() for line in plotting.plot_runs(both).axes[0].get_lines()]
    assert len(labels) == 4
    assert len({str(label).partition(",")[0] for label in labels}) == 2


def test_a_figure_can_be_restyled_and_leaves_settings_alone() -> None:
    before = dict(mpl.rcParams)
    figure = plotting.plot_runs(RUNS)
    line = figure.axes[0].get_lines()[0]
    line.set_color("red")
    figure.axes[0].set_ylabel("mine")
    shown: Any = figure
    assert shown._repr_png_()
    assert line.get_color() == "red"
    assert dict(mpl.rcParams) == before


EMPTY: SeparationGrid = as_grid(list(grid(["1e-9"] * 3, ["1e-9"] * 3).points[:1]))


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: plotting.plot_runs([]), "runs"),
        (lambda: plotting.plot_runs(RUNS, "area"), "quantity"),
        (lambda: plotting.plot_runs(RUNS[:1]), "runs"),
        (lambda: plotting.plot_over_time(run()), "run"),
        (lambda: plotting.plot_separation(EMPTY), "grid"),
        (lambda: plotting.plot_growth([]), "laws"),
        (lambda: plotting.plot_work_precision(result()), "found"),
        (lambda: plotting.plot_table(claim()), "claim"),
        (lambda: plotting.plot_flow(flow(FAILED)), "flow"),
    ],
)
def test_what_there_is_nothing_to_draw_of_is_an_error(make: Callable[[], Any], name: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.name == name
