"""What one room takes from another says what it is: it has a docstring."""

import ast
from collections.abc import Collection, Iterator
from functools import cache

import pytest

from tests.helpers.imports import NAMES, import_statements, rooms_of, tree_of

Definition = ast.FunctionDef | ast.ClassDef


@cache
def taken() -> frozenset[tuple[str, str]]:
    """(module, name) of all that one room imports from another, modules apart."""
    return frozenset(
        (node.module, alias.name)
        for importer, path in NAMES.items()
        for node in import_statements(path)
        if isinstance(node, ast.ImportFrom) and node.module in NAMES
        for alias in node.names
        if rooms_of(node.module) != rooms_of(importer)
        and f"{node.module}.{alias.name}" not in NAMES
    )


def speaks_for_itself(method: ast.FunctionDef) -> bool:
    """Whether it is one statement that returns, or a protocol's `...`."""
    (first, *more) = method.body
    return not more and isinstance(first, ast.Return | ast.Expr)


def public(body: Collection[ast.stmt]) -> Iterator[Definition]:
    """Those without an underscore, but for a function's further signatures."""
    for node in body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith("_"):
            continue
        if not any(ast.unparse(x) == "overload" for x in node.decorator_list):
            yield node


def without(tree: ast.Module, names: Collection[str]) -> list[str]:
    """Which of a module's names, and of the public methods of its classes, have no docstring."""
    found = []
    for node in public(tree.body):
        if node.name not in names:
            continue
        if not ast.get_docstring(node):
            found.append(node.name)
        for inner in public(node.body) if isinstance(node, ast.ClassDef) else ():
            simple = isinstance(inner, ast.FunctionDef) and speaks_for_itself(inner)
            if not simple and not ast.get_docstring(inner):
                found.append(f"{node.name}.{inner.name}")
    return found


def silent() -> dict[str, set[str]]:
    """What has no docstring, by rooms."""
    found: dict[str, set[str]] = {}
    names: dict[str, set[str]] = {}
    for module, name in taken():
        names.setdefault(module, set()).add(name)
    for module, wanted in names.items():
        for name in without(tree_of(NAMES[module]), wanted):
            found.setdefault(rooms_of(module), set()).add(f"{module}.{name}")
    return found


@pytest.mark.left_to_ci
def test_what_other_rooms_use_has_a_docstring() -> None:
    assert not silent()


def test_the_rule_speaks_of_what_there_is() -> None:
    assert {("verify.schemes.scheme", "Scheme"), ("verify.errors", "InputError")} <= taken()


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("def shown(x):\n    return x", ["shown"]),
        ("def shown(x):\n    'The text of x.'\n    return x", []),
        ("def _shown(x):\n    return x", []),
        ("class Ring:\n    'A ring.'\n    def add(self):\n        x = 1\n        return x",
         ["Ring.add"]),
        ("class Ring:\n    'A ring.'\n    def zero(self):\n        return 0", []),
        ("class Ring:\n    def _add(self):\n        x = 1\n        return x", ["Ring"]),
    ],
)  # fmt: skip
def test_what_has_none_is_seen(source: str, found: list[str]) -> None:
    assert without(ast.parse(source), {"shown", "_shown", "Ring"}) == found
