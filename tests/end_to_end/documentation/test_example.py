"""The notebook of docs/how-to/notebooks.md, run as it is printed."""

from typing import Any

import pytest
from matplotlib.figure import Figure

from tests.helpers.pages.blocks import PAGES
from tests.helpers.pages.session import read_through


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return read_through(
        PAGES["docs/how-to/notebooks.md"], tmp_path_factory.mktemp("notebook")
    ).names


@pytest.mark.left_to_ci
def test_the_proof_has_order_3_and_shows_it(made: dict[str, Any]) -> None:
    assert made["proof"].order == 3
    assert "3*p*q" in made["proof"]._repr_html_()
    assert "h^{3}" in made["proof"]._repr_latex_()


def test_the_runs_show_their_numbers_with_bounds(made: dict[str, Any]) -> None:
    for found in made["runs"]:
        shown = found._repr_html_()
        value = found.values["lambda"]
        assert value.value in shown
        assert value.bound in shown


def test_the_separation_shows_every_step_size(made: dict[str, Any]) -> None:
    shown = made["parts"]._repr_html_()
    for point in made["parts"].points:
        assert f">{point.step_size}<" in shown
        assert point.plain.parts.total.value in shown


@pytest.mark.parametrize("name", ["figure", "against_rounding", "over_time"])
def test_the_figures_are_matplotlibs_with_labels(made: dict[str, Any], name: str) -> None:
    figure = made[name]
    assert isinstance(figure, Figure)
    assert figure.axes[-1].get_xlabel()
    assert all(axes.get_ylabel() for axes in figure.axes)


def test_the_title_is_the_users(made: dict[str, Any]) -> None:
    axes = made["figure"].axes[0]
    assert "Duffing, δ = 1, t from 0 to 20" in {axes.get_title(loc=at) for at in ("left", "center")}
