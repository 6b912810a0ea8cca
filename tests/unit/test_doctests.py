"""Every example in a docstring gives what it says."""

import doctest
from importlib import import_module
from types import ModuleType

import pytest

from tests.helpers.imports import NAMES

# A module without an example is not imported, so that no optional library is.
WITH_EXAMPLES = sorted(n for n, path in NAMES.items() if ">>> " in path.read_text(encoding="utf-8"))


def failed(module: ModuleType) -> int:
    return doctest.testmod(module).failed


@pytest.mark.parametrize("name", WITH_EXAMPLES)
def test_examples_give_what_they_say(name: str) -> None:
    module = import_module(name)
    assert any(test.examples for test in doctest.DocTestFinder().find(module)), "none is seen"
    assert not failed(module)


def test_there_are_examples() -> None:
    assert {"verify.prose", "verify.arithmetic.exact"} <= set(WITH_EXAMPLES)


@pytest.mark.parametrize(("said", "wrong"), [("4", 0), ("5", 1)])
def test_a_wrong_example_is_seen(said: str, wrong: int) -> None:
    planted = ModuleType("planted", f"\n>>> 2 + 2\n{said}\n")
    assert failed(planted) == wrong
