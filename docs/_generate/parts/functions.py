"""The elementary functions of formulas: where each is defined, and what others call it."""

import sympy

from docs._generate.markdown import code, codes, table
from verify.functions import by_name
from verify.functions.function import Function

_HEAD = ("function", "also written", "is defined where", "in fixed point")
_RELATIONS = {"!=": "≠", ">=": "≥", ">": ">"}


def text() -> str:
    """A table of all of them."""
    return table(_HEAD, map(_row, by_name().values()))


def _row(function: Function) -> tuple[str, ...]:
    domain, inside = function.domain, "everywhere"
    if domain is not None:
        argument = domain.inside(sympy.Symbol("x"))
        inside = f"{domain.through} {argument} {_RELATIONS[domain.relation]} 0".strip()
    composed = function.image is None and function.fixed is None
    return (
        code(function.name),
        codes(function.synonyms),
        inside,
        "of others" if composed else "yes" if function.fixed else "no",
    )
