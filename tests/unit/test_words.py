"""Few names are words that say nothing, and few docstrings begin as riddles do.

The dictionary is the section "Names and sentences" of CONTRIBUTING.md. What is left are keys of
published JSON and public attributes. A limit is lowered when names are mended, and never raised.
"""

import ast
import io
import re
import tokenize
from collections.abc import Iterator

import pytest

from tests.paths import ROOT

NO_NAMES = {"found", "known", "own", "made", "given", "asked", "told", "there"}
NO_VERBS = re.compile(
    r"_?(?!need|embed|speed|feed|seed|proceed|succeed)([a-z]+ed|of|at|within|beside|made|found|told"
    r"|kept|known|shown|written|taken|given|held|built|said|own)"
)
NO_BEGINNINGS = {"What", "Whether", "Of", "How", "Those", "That", "Where", "Who", "Whose"}
FILES = sorted(ROOT.joinpath("verify").rglob("*.py"))
LIMITS = {"identifiers": 35, "functions": 12, "first lines": 5}


def identifiers(text: str) -> Iterator[str]:
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME and token.string in NO_NAMES:
            yield token.string


def functions(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and NO_VERBS.fullmatch(node.name):
            yield node.name


def first_lines(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            words = (ast.get_docstring(node) or "").split()
            if words and words[0] in NO_BEGINNINGS:
                yield f"{node.name}: {words[0]}"


COUNTED = {"identifiers": identifiers, "functions": functions, "first lines": first_lines}


@pytest.mark.parametrize("kind", COUNTED)
def test_no_more_are_awkward_than_there_were(kind: str) -> None:
    places = [
        f"{path.relative_to(ROOT)}: {word}"
        for path in FILES
        for word in COUNTED[kind](path.read_text())
    ]
    assert len(places) <= LIMITS[kind], "\n".join(places)


def test_each_kind_is_seen() -> None:
    text = 'def told(x):\n    """Whether it is."""\n    found = x\n    return found\n'
    assert list(identifiers(text)) == ["told", "found", "found"]
    assert list(functions(text)) == ["told"]
    assert list(first_lines(text)) == ["told: Whether"]
    assert not [
        *identifiers("order = 1"),
        *functions("def read(x): ..."),
        *functions("def seed(): ..."),
    ]
