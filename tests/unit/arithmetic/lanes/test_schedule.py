"""Statements in another order do the same, and those that are independent stand apart."""

import ast
from typing import Any

import pytest

from verify.arithmetic.lanes import schedule
from verify.arithmetic.lanes.schedule import reorder

LOOP = """\
a = p * p
b = a * q
c = b * p
d = q * q
if d > top: top = d
e = d * p
size = abs(c)
if size > most: most = size
d = e * 2
p = p + d
q = q + c
"""
START = {"p": 3, "q": 5, "top": 7, "most": 11, "abs": abs}


def after(statements: list[ast.stmt]) -> dict[str, Any]:
    scope = dict(START)
    exec(compile(ast.Module(statements, []), "loop", "exec"), scope)  # noqa: S102 - ours
    return {name: x for name, x in scope.items() if isinstance(x, int)}


def test_another_order_does_the_same() -> None:
    statements = ast.parse(LOOP).body
    other = reorder(statements)
    assert sorted(map(ast.dump, other)) == sorted(map(ast.dump, statements))
    assert after(other) == after(statements)


def test_what_waits_for_a_product_does_not_stand_right_behind_it() -> None:
    order = [ast.unparse(x) for x in reorder(ast.parse(LOOP).body)]
    assert order.index("d = q * q") < order.index("b = a * q")


def test_a_return_stays_where_it_is() -> None:
    statements = ast.parse("a = p * p\nif a > q: pass\nb = q * q\n").body
    guard = statements[1]
    assert isinstance(guard, ast.If)
    guard.body = [ast.Return()]
    assert reorder(statements)[1] is guard


@pytest.mark.parametrize("planted", ["_dependencies"])
def test_an_order_without_dependencies_is_caught(
    monkeypatch: pytest.MonkeyPatch, planted: str
) -> None:
    monkeypatch.setattr(schedule, planted, lambda statements: [set() for _ in statements])
    statements = ast.parse(LOOP).body
    try:
        wrong = after(reorder(statements)) != after(statements)
    except NameError:
        wrong = True
    assert wrong
