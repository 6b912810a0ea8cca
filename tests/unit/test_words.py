"""Few names are words that say nothing, and few docstrings begin as riddles do.

The dictionary is the section "Names and sentences" of CONTRIBUTING.md. What is left are keys of
published JSON and public attributes. A limit is lowered when names are mended, and never raised.
"""

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.helpers.imports import MODULES, nodes_of
from tests.paths import ROOT

NO_NAMES = {"found", "known", "own", "made", "given", "asked", "told", "there"}
NO_VERBS = re.compile(
    r"_?(?!(?:need|embed|speed|feed|seed|proceed|succeed)$)([a-z]+ed|of|at|within|beside|made|found"
    r"|told|kept|known|shown|written|taken|given|held|built|said|own)"
)
NO_BEGINNINGS = {"What", "Whether", "Of", "How", "Those", "That", "Where", "Who", "Whose"}
LIMITS = {"identifiers": 35, "functions": 12, "first lines": 5}


def identifiers(path: Path) -> Iterator[str]:
    text = io.StringIO(path.read_text(encoding="utf-8"))
    for token in tokenize.generate_tokens(text.readline):
        if token.type == tokenize.NAME and token.string in NO_NAMES:
            yield token.string


def functions(path: Path) -> Iterator[str]:
    for node in nodes_of(path):
        if isinstance(node, ast.FunctionDef) and NO_VERBS.fullmatch(node.name):
            yield node.name


def first_lines(path: Path) -> Iterator[str]:
    for node in nodes_of(path):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            words = (ast.get_docstring(node) or "").split()
            if words and words[0] in NO_BEGINNINGS:
                yield f"{node.name}: {words[0]}"


COUNTED = {"identifiers": identifiers, "functions": functions, "first lines": first_lines}


@pytest.mark.parametrize("kind", COUNTED)
def test_no_more_are_awkward_than_there_were(kind: str) -> None:
    places = [
        f"{path.relative_to(ROOT)}: {word}" for path in MODULES for word in COUNTED[kind](path)
    ]
    assert len(places) <= LIMITS[kind], "\n".join(places)


def test_each_kind_is_seen(tmp_path: Path) -> None:
    awkward, plain = tmp_path / "awkward.py", tmp_path / "plain.py"
    awkward.write_text('def told(x):\n    """Whether it is."""\n    found = x\n    return found\n')
    assert list(identifiers(awkward)) == ["told", "found", "found"]
    assert list(functions(awkward)) == ["told"]
    assert list(first_lines(awkward)) == ["told: Whether"]
    plain.write_text("order = 1\ndef read(): ...\ndef seed(): ...\n")
    assert not [*identifiers(plain), *functions(plain), *first_lines(plain)]


def test_a_participle_that_begins_as_a_noun_does_is_one() -> None:
    assert NO_VERBS.fullmatch("_needed")
    assert not NO_VERBS.fullmatch("_need")
