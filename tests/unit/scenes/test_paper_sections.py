"""The figures of a paper that are to be made again: what their tables may say."""

from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.errors import InputError

SCENE = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2"]
[grid]
steps = 5
step_sizes = [0.1]
initial_values = [{ q = 1, p = 0 }]
[[series]]
step_size = 0.1
steps = 5
initial_value = { q = 1, p = 0 }
source = "Figure 2"
[[flow]]
shape = "circle"
step_size = 0.1
steps = [5]
source = "Figure 3"
"""
CLAIM = """
[[claim]]
id = "order"
scene = "mine"
scheme = "lie2"
kind = "order"
order = 3
"""
FIGURE = """
[[figure]]
label = "Figure 3"
scene = "mine"
shows = "flow"
claims = ["order"]
"""


def figures(folder: Path, text: str) -> list[tuple[str, str]]:
    (folder / "mine.toml").write_text(SCENE)
    (folder / "claims.toml").write_text(CLAIM + text)
    return [(f.label, f.shows) for f in load_claims(folder / "claims.toml").figures]


def test_a_figure_shows_runs_a_series_or_a_flow_of_its_scene(tmp_path: Path) -> None:
    more = FIGURE.replace("Figure 3", "Figure 2").replace('"flow"', '"series"')
    runs = FIGURE.replace("Figure 3", "Any name").replace('"flow"', '"runs"')
    assert figures(tmp_path, FIGURE + more + runs) == [
        ("Figure 3", "flow"), ("Figure 2", "series"), ("Any name", "runs"),
    ]  # fmt: skip


BAD = {
    "unknown-claim": (('["order"]', '["disorder"]'), "claims=disorder: is no id of a claim"),
    "unknown-scene": (('"mine"', '"other"'), "scene=other: there is no other.toml"),
    "no-such-flow": (("Figure 3", "Figure 4"), r"label=Figure 4: .* has no \[\[flow\]\] of it"),
    "no-such-series": (('"flow"', '"series"'), r"has no \[\[series\]\] of it"),
    "unknown-kind": (('"flow"', '"film"'), "shows=film"),
    "unknown-key": (("label", "title = 1\nlabel"), "title=1: unknown key"),
    "no-label": (('label = "Figure 3"\n', ""), "label: is missing"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_figure_is_told_in_one_line_with_its_place(name: str, tmp_path: Path) -> None:
    (old, new), said = BAD[name]
    with pytest.raises(InputError, match=said) as error:
        figures(tmp_path, FIGURE.replace(old, new))
    assert "claims.toml:9: figure" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_label_that_stands_twice_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="stands twice"):
        figures(tmp_path, FIGURE + FIGURE)
