"""A splitting of a field f = f₁ + f₂ + …: the exact flows of its parts, one after the other.

The parts have names, and a scheme says how long each flows: `A 1/2; B 1; A 1/2`. The flow of a part
is exact where its Lie series ends, Xⁿz = 0, as that of a shear does: what it moves does not change
its own velocity.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.arithmetic.exact import rational
from verify.effort import limit_effort
from verify.errors import InputError, unknown_name
from verify.hamiltonians.equations import Equations, are_equations, read_system
from verify.lazy_sympy import sympy
from verify.schemes import separate_title
from verify.schemes.maps.formula_map import map_from_expressions
from verify.schemes.maps.step_map import StepMap
from verify.structures.structure import is_zero

_NAME = r"[A-Za-z]\w*"
_STEP = re.compile(rf"\s*({_NAME})\s+(\S+)\s*", re.ASCII)
_WITH = re.compile(rf"\swith\s+(?={_NAME}\s*:)", re.ASCII)
_PART = re.compile(rf"(?:^|;)\s*({_NAME})\s*:", re.ASCII)
_MAX_STEPS = 200
_MAX_POWER = 8  # the power of X at which a part's Lie series has ended


# -- the text of a splitting -----------------------------------------------------------------------


def has_steps(scheme: str) -> bool:
    """Return True if a scheme is written as parts with their sizes, without what the parts are.

    >>> has_steps("A 1/2; B 1; A 1/2"), has_steps("rk4"), has_steps("A 1 with A: x_dot = 1")
    (True, False, False)
    """
    _, steps = separate_title(scheme)
    return all(map(_STEP.fullmatch, steps.strip().rstrip(";").split(";")))


def add_parts(scheme: str, parts: Mapping[str, str]) -> str:
    """Return the text of a scheme with its parts, by which `schemes.get` reads it.

    Raises InputError for what is no name of a part, and for an unknown part in the scheme.

    >>> add_parts("A 1; B 1", {"A": "x_dot = y", "B": "y_dot = -x"})
    'A 1; B 1 with A: x_dot = y; B: y_dot = -x'
    """
    for name, field in parts.items():
        if not re.fullmatch(_NAME, name, re.ASCII):
            raise InputError("split", name, "is no name of a part: letters, digits and _")
        if ":" in field:
            raise InputError("split", field.strip(), "has a colon; give each part by itself")
    title, text = separate_title(scheme)
    steps = "; ".join(f"{name} {size}" for name, size in _steps(text, parts))
    fields = "; ".join(f"{name}: {field.strip()}" for name, field in parts.items())
    return f"{f'{title}: ' if title else ''}{steps} with {fields}"


def separate_parts(scheme: str) -> tuple[str, dict[str, str]]:
    """Return a scheme's steps, and the equations of its parts by name; none of any other scheme.

    >>> separate_parts("A 1; B 1 with A: x_dot = y; B: y_dot = -x")
    ('A 1; B 1', {'A': 'x_dot = y', 'B': 'y_dot = -x'})
    """
    match = _WITH.search(scheme)
    if match is None:
        return scheme, {}
    _, *texts = _PART.split(scheme[match.end() :])
    parts: dict[str, str] = {}
    for name, field in zip(texts[::2], texts[1::2], strict=True):
        if name in parts:
            raise InputError("split", name, "stands twice; each part has a name of its own")
        parts[name] = field.strip()
    return scheme[: match.start()].rstrip(), parts


def _steps(scheme: str, names: Mapping[str, object]) -> list[tuple[str, str]]:
    """Return the names of parts, each with the size of its step, a number in parts of h."""
    steps = []
    texts = scheme.strip().rstrip(";").split(";")
    if len(texts) > _MAX_STEPS:
        raise InputError("scheme", len(texts), f"parts are more than {_MAX_STEPS}")
    for text in texts:
        match = _STEP.fullmatch(text)
        if match is None:
            raise InputError("scheme", text.strip(), "is no part with its size, such as A 1/2")
        name, size = match.groups()
        if name not in names:
            raise unknown_name("scheme", name, tuple(names))
        rational(size, f"the size of {name}")
        steps.append((name, size))
    return steps


# -- its map ---------------------------------------------------------------------------------------


def splitting_map(equations: Equations, scheme: str, parts: Mapping[str, str]) -> StepMap:
    """Return the step of a splitting: the flows of its parts in the order of the scheme.

    `scheme`: such as `A 1/2; B 1; A 1/2`. `parts`: the equations of each part by its name; a
    coordinate that a part does not move may be left out. Raises InputError if the parts do not add
    up to the field, or a part has no flow that is a polynomial in time.
    """
    fields = {name: _field(equations, name, text) for name, text in parts.items()}
    _check_sum(equations, list(fields.values()))
    flows = {name: _flow(equations, name, field) for name, field in fields.items()}
    symbols = [symbol(name) for name in equations.names]
    state: Sequence[sympy.Expr] = symbols
    h = symbol("h")
    with limit_effort("scheme", scheme, "to compose its parts"):
        for name, size in _steps(scheme, flows):
            images = dict(zip(symbols, state, strict=True))
            images[h] = h * sympy.Rational(str(rational(size, name)))
            state = [x.xreplace(images) for x in flows[name]]
    return map_from_expressions(equations, [equations.substitute_values(x) for x in state])


def _check_sum(equations: Equations, fields: Sequence[Sequence[sympy.Expr]]) -> None:
    """Raise InputError unless the parts add up to the field."""
    for k, name in enumerate(equations.names):
        total = sympy.Add(*(field[k] for field in fields))
        is_same = is_zero(equations.expression[k] - total, (*equations.names, "t"))
        if is_same is not True:
            verb = "do not add up" if is_same is False else "are not shown to add up"
            sides = f"{to_text(total)}, and the field has {to_text(equations.expression[k])}"
            raise InputError("split", f"{name}_dot", f"the parts {verb} to the field: {sides}")


def _field(equations: Equations, name: str, text: str) -> Sequence[sympy.Expr]:
    place, names = f"{name}: {text}", ", ".join(f"{x}_dot" for x in equations.names)
    try:
        part = read_system(text) if are_equations(text) else None
    except InputError as error:
        raise type(error)("split", place, error.problem) from None
    if not isinstance(part, Equations) or not {*part.names} <= {*equations.names}:
        raise InputError("split", place, f"has other equations than the field's {names}")
    if part.time_dependent:
        raise InputError("split", place, "depends on t, and has no flow of its own")
    by_name = dict(zip(part.names, part.expression, strict=True))
    return [by_name.get(x, sympy.S.Zero) for x in equations.names]


def _flow(equations: Equations, name: str, field: Sequence[sympy.Expr]) -> Sequence[sympy.Expr]:
    """Return the exact flow of a part in the time h, Σ hⁿ/n! Xⁿz."""
    symbols, h = [symbol(x) for x in equations.names], symbol("h")
    term, total = list(symbols), list(symbols)
    for n in range(1, _MAX_POWER + 1):
        term = [
            sympy.Add(*(f * x.diff(z) for f, z in zip(field, symbols, strict=True))) for x in term
        ]
        if all(is_zero(x, equations.names) is True for x in term):
            return total
        total = [x + h**n / math.factorial(n) * y for x, y in zip(total, term, strict=True)]
    moved = "; ".join(
        f"{x}_dot = {to_text(f)}" for x, f in zip(equations.names, field, strict=True) if f != 0
    )
    problem = "is a part with no flow that is a polynomial in time; split it further"
    raise InputError("split", f"{name}: {moved}", problem)
