"""What stands below a field of a model: the docstring of an attribute, which Python throws away."""

import ast
import inspect
from functools import cache
from itertools import pairwise

from pydantic import BaseModel


def texts(model: type[BaseModel]) -> dict[str, str]:
    """The text of each field that has one, those of the bases too."""
    found: dict[str, str] = {}
    for each in reversed(model.__mro__):
        if issubclass(each, BaseModel) and each is not BaseModel:
            found |= _own(each)
    return {name: text for name, text in found.items() if name in model.model_fields}


@cache
def _own(model: type[BaseModel]) -> dict[str, str]:
    body = [node for each in ast.parse(inspect.getsource(model)).body for node in _within(each)]
    return {
        field.target.id: inspect.cleandoc(text.value.value)
        for field, text in pairwise(body)
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        if isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
        if isinstance(text.value.value, str)
    }


def _within(node: ast.stmt) -> list[ast.stmt]:
    return node.body if isinstance(node, ast.ClassDef) else []
