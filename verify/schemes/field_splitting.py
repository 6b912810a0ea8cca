"""A splitting of a field f = f₁ + f₂ + …: the exact flows of its parts, one after the other.

The parts have names, and a scheme says how long each flows: `A 1/2; B 1; A 1/2`. The flow of a part
is exact where its Lie series ends, Xⁿz = 0, as that of a shear does: what it moves does not change
its own velocity.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.arithmetic.exact import rational
from verify.effort import limit_effort
from verify.errors import InputError, unknown_name
from verify.hamiltonians.equations import Equations, read_system
from verify.lazy_sympy import sympy
from verify.structures.structure import is_zero

_PART = re.compile(r"\s*([A-Za-z]\w*)\s+(\S+)\s*", re.ASCII)
_MAX_POWER = 8  # the power of X at which a part's Lie series has ended


def formulas_of_splitting(equations: Equations, parts: Mapping[str, str], scheme: str) -> str:
    """Return the step of a splitting as formulas `u_next = …; v_next = …`.

    `parts`: the equations of each part by its name; a coordinate that a part does not move may be
    left out. `scheme`: such as `A 1/2; B 1; A 1/2`. Raises InputError if the parts do not add up to
    the field, or a part has no flow that is a polynomial in time.
    """
    fields = {name: _field(equations, name, text) for name, text in parts.items()}
    for k, name in enumerate(equations.names):
        rest = equations.expression[k] - sympy.Add(*(field[k] for field in fields.values()))
        if is_zero(rest, (*equations.names, "t")) is not True:
            raise InputError("split", name, "the parts do not add up to the field")
    flows = {name: _flow(equations, name, field) for name, field in fields.items()}
    state = [symbol(name) for name in equations.names]
    h = symbol("h")
    with limit_effort("scheme", scheme, "to compose its parts"):
        for name, size in _steps(scheme, flows):
            images = dict(zip(map(symbol, equations.names), state, strict=True))
            images[h] = h * sympy.Rational(size.numerator, size.denominator)
            state = [x.xreplace(images) for x in flows[name]]
    pairs = zip(equations.names, state, strict=True)
    return "; ".join(f"{name}_next = {to_text(x)}" for name, x in pairs)


def _field(equations: Equations, name: str, text: str) -> Sequence[sympy.Expr]:
    part = read_system(text)
    if not isinstance(part, Equations) or not {*part.names} <= {*equations.names}:
        names = ", ".join(f"{x}_dot" for x in equations.names)
        raise InputError("split", text, f"part {name} has other equations; allowed: {names}")
    if part.time_dependent:
        raise InputError("split", text, f"part {name} depends on t, and has no flow of its own")
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
    problem = f"part {name} has no flow that is a polynomial in time"
    raise InputError("split", f"{name}: {equations.formula}", f"{problem}; split it further")


def _steps(scheme: str, names: Mapping[str, object]) -> list[tuple[str, Fraction]]:
    steps = []
    for text in scheme.strip().rstrip(";").split(";"):
        match = _PART.fullmatch(text)
        if match is None:
            raise InputError("scheme", text.strip(), "is no part with its size, such as A 1/2")
        name, size = match.groups()
        if name not in names:
            raise unknown_name("scheme", name, tuple(names))
        steps.append((name, rational(size, f"the size of {name}")))
    return steps
