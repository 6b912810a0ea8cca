"""The manual: every page has its place, and the parts that the code writes leave nothing out."""

import re
from pathlib import Path

import click
import pytest
from pydantic import BaseModel

import verify
from docs._generate.attribute_texts import texts
from docs._generate.classical_methods import METHODS
from docs._generate.commands import contexts
from docs._generate.docstrings import as_rst
from docs._generate.keys import keys
from docs._generate.links import within_manual
from docs._generate.markdown import table
from docs._generate.parts import PARTS, asked_for, filled
from docs._generate.toctrees import chapters, with_toctrees
from tests.helpers.pages.blocks import DOCS, PAGES
from verify import arithmetic, functions, schemes
from verify.claims.kinds import models
from verify.hamiltonians import systems
from verify.scenes.scene import Scene

INDEX = PAGES["docs/README.md"]


def placed(index: str) -> list[str]:
    """The pages in the toctrees of an index."""
    return [page for _, pages in chapters(index) for page in pages]


def test_every_page_stands_in_one_toctree() -> None:
    pages = {name.removeprefix("docs/").removesuffix(".md") for name in PAGES} - {"README"}
    assert sorted(placed(INDEX)) == sorted(page for page in pages if "/" in page)
    assert [name for name, _ in chapters(INDEX)] == [
        "Tutorial", "How-to", "Reference", "Explanation"
    ]  # fmt: skip


def test_a_page_that_is_in_none_is_seen() -> None:
    (line,) = (line for line in INDEX.splitlines() if "(how-to/flow.md)" in line)
    assert "how-to/flow" in placed(INDEX)
    assert "how-to/flow" not in placed(INDEX.replace(line, ""))


def test_a_toctree_says_its_pages_and_shows_none() -> None:
    made = with_toctrees("# Manual\n\n## To read\n\n[one](to/one.md), [two](to/two.md#part)\n")
    assert made.endswith("```{toctree}\n:hidden:\n:caption: To read\n\nto/one\nto/two\n```\n")


# -- parts that the code writes -------------------------------------------------------------------


def test_every_part_has_its_place_on_one_page() -> None:
    asked = [part for page in PAGES.values() for part in asked_for(page)]
    assert sorted(asked) == sorted(PARTS.names)


def test_a_mark_becomes_its_part_and_one_of_no_part_fails() -> None:
    made = filled("before\n\n<!-- generated: number-systems -->\n\nafter")
    assert "`float64`" in made
    assert "generated" not in made
    with pytest.raises(KeyError):
        filled("<!-- generated: number-sistems -->")


NAMED = {
    "command-line": [context.command_path for context in contexts()],
    "claim-kinds": [*models()],
    "classical-methods": [method.name for method in METHODS],
    "functions": functions.names(),
    "number-systems": arithmetic.names(),
    "python-api": [f"verify.{name}" for name in verify.__all__],
    "results-json": ["SceneResult", "ClaimResult", "Provenance"],
    "scene-keys": [*Scene.model_fields],
    "schemes": schemes.names(),
    "systems": systems.names(),
}


def test_what_each_part_has_to_name_is_known_here() -> None:
    assert sorted(NAMED) == sorted(PARTS.names)
    assert "verify reference make" in NAMED["command-line"]


@pytest.mark.parametrize("part", sorted(NAMED))
def test_a_part_names_all_that_there_is(part: str) -> None:
    text = PARTS.module(part).text()
    assert not [name for name in NAMED[part] if not _names(text, name)]
    assert not _names(text, "lie7000")


def _names(text: str, name: str) -> bool:
    return re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", text) is not None


def test_every_option_stands_below_its_command() -> None:
    text = PARTS.module("command-line").text()
    for context in contexts():
        section = text.split(f"### {context.command_path}\n")[1].split("\n### ")[0]
        options = (p for p in context.command.params if isinstance(p, click.Option))
        assert not [name for p in options for name in p.opts if name not in section]


class Plain(BaseModel):
    """One key with a text and one without."""

    told: int = 3
    """How many."""
    untold: int = 4


def test_a_key_of_which_nothing_is_said_is_no_key_of_the_manual() -> None:
    assert texts(Plain) == {"told": "How many."}
    assert "| `told` | whole number | `3` | How many. |" in keys(Plain, ["untold"])
    with pytest.raises(KeyError, match="untold"):
        keys(Plain)


def test_a_table_leaves_out_a_column_that_is_empty_and_ends_no_cell_early() -> None:
    assert (
        table(("a", "b", "c"), [("1", "", "|x|")]) == "| a | c |\n| --- | --- |\n| 1 | \\|x\\| |\n"
    )


# -- what is read otherwise than it stands --------------------------------------------------------


@pytest.mark.parametrize(
    ("docstring", "shown"),
    [
        ("The largest |ΔJ| of p**2.", r"The largest \|ΔJ\| of p\*\*2."),
        ("Of `q_next` and\n`p`.", "Of ``q_next``\\  and ``p``\\ ."),
        ("As:\n\n    verify run", "As:\n\n::\n\n    verify run"),
        (">>> 1 + 1\n2", ">>> 1 + 1\n2"),
        ("Parameters\n---\nq, p: exact\n    numbers.\nh: a_b.",
         "**Parameters**\n\n``q``, ``p``\n    exact numbers.\n``h``\n    a\\_b."),
    ],
)  # fmt: skip
def test_a_docstring_is_sentences_with_code(docstring: str, shown: str) -> None:
    assert "\n".join(as_rst(docstring.splitlines())).strip() == shown


@pytest.mark.parametrize(
    ("link", "shown"),
    [
        ("[x](../how-to/run.md#head)", "[x](../how-to/run.md#head)"),
        ("[x](../../ARCHITECTURE.md)", "[x](path:../../ARCHITECTURE.md)"),
        ("[x](../../tests/bench)", "x"),
        ("![x](../../reports/paper/cat.png)", "![x](../../reports/paper/cat.png)"),
        ("[x](run.md)", "[x](run.md)"),
    ],
)
def test_a_link_out_of_the_manual_is_one_that_a_build_can_follow(link: str, shown: str) -> None:
    assert within_manual(f"a {link} b", DOCS / "reference", DOCS) == f"a {shown} b"
    assert Path(DOCS, "reference").is_dir()
