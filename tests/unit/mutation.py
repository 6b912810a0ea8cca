"""Formulas with one thing in them changed, made on their syntax trees."""

import ast
import copy
from collections.abc import Iterator
from typing import Any

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


class Replace(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> Any:
        return self.new if node is self.old else self.generic_visit(node)


def mutants(formula: str) -> list[str]:
    """The formula with one thing in it changed, in every way."""
    found: list[str] = []
    count = len(list(ast.walk(ast.parse(formula, mode="eval"))))
    for index in range(count):
        tree = ast.parse(formula, mode="eval")
        node = list(ast.walk(tree))[index]
        in_call = {id(n.func) for n in ast.walk(tree) if isinstance(n, ast.Call)}
        for word, new in changes_of(node):
            if id(node) in in_call and word == "power":
                continue
            copied = ast.parse(formula, mode="eval")
            target = list(ast.walk(copied))[index]
            text = ast.unparse(ast.fix_missing_locations(Replace(target, new).visit(copied)))
            if "/ 0" not in text and text not in found:
                found.append(text)
    return found
