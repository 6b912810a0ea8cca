"""Formulas with one thing in them changed, made on their syntax trees."""

import ast
import copy
from collections.abc import Iterator

SWAPS = {"p": ["q"], "q": ["p"], "p_next": ["p", "q"], "delta": ["h"], "h": ["q"],
         "sin": ["cos"], "cos": ["sin"]}  # fmt: skip


def changes_of(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """What can be changed at one node of a formula, each with a word for it."""
    match node:
        case ast.BinOp(op=ast.Add() | ast.Sub()):
            other = copy.deepcopy(node)
            other.op = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()
            yield "sign", other
            yield "term lost", node.left
            alone = (
                node.right if isinstance(node.op, ast.Add) else ast.UnaryOp(ast.USub(), node.right)
            )
            yield "term lost", alone
            twice = [ast.BinOp(ast.Constant(2), ast.Mult(), x) for x in (node.left, node.right)]
            yield "term doubled", ast.BinOp(node.left, node.op, twice[1])
            yield "term doubled", ast.BinOp(twice[0], node.op, node.right)
        case ast.BinOp(op=ast.Mult() | ast.Div()):
            negated = ast.UnaryOp(ast.USub(), copy.deepcopy(node.left))
            yield "sign", ast.BinOp(negated, node.op, node.right)
        case ast.UnaryOp(op=ast.USub()):
            yield "sign", node.operand
        case ast.Constant(value=n):
            yield from (("number", ast.Constant(n + d)) for d in (1, -1))
        case ast.Name(id=name):
            yield "power", ast.BinOp(node, ast.Pow(), ast.Constant(2))
            yield from (("name", ast.Name(other)) for other in SWAPS.get(name, ()))


def put(above: ast.AST, place: tuple[str, int | None], new: ast.AST) -> None:
    """Sets a node's field, or one thing in a field that is a list."""
    field, index = place
    if index is None:
        setattr(above, field, new)
    else:
        getattr(above, field)[index] = new


def below(above: ast.AST) -> Iterator[tuple[tuple[str, int | None], ast.AST]]:
    """The nodes right below one, each with its place."""
    for field, value in ast.iter_fields(above):
        if isinstance(value, ast.AST):
            yield (field, None), value
        elif isinstance(value, list):
            yield from (((field, k), x) for k, x in enumerate(value) if isinstance(x, ast.AST))


def mutants(formula: str) -> list[str]:
    """The formula with one thing in it changed, in every way."""
    found: dict[str, None] = {}
    tree = ast.parse(formula, mode="eval")
    nodes = list(ast.walk(tree))
    # A node that is shared, as x's ast.Load is, has no changes.
    above = {id(node): (each, place) for each in nodes for place, node in below(each)}
    in_call = {id(node.func) for node in nodes if isinstance(node, ast.Call)}
    for node in nodes:
        for word, new in changes_of(node):
            if id(node) in in_call and word == "power":
                continue
            put(*above[id(node)], new)
            text = ast.unparse(tree)
            put(*above[id(node)], node)
            if "/ 0" not in text:
                found[text] = None
    return list(found)
