"""Derivatives of H in a user's formulas, with the point at which they are taken: H_q(p_half, q).

An argument that is named for a coordinate, such as p_half or q_next, is that coordinate in any
place; of the others each takes the place of a coordinate of which the derivative depends and which
is still missing, if it is the only one. `H_q(p=…, q=…)` says all.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from verify.algebra.domain import FormulaDomain
from verify.algebra.formula import MAX_LENGTH, read, symbol
from verify.errors import InputError, LimitError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy

_CALLED = re.compile(r"H_\w+", re.ASCII)
_MOST_NESTED = 20  # derivatives, each in an argument of another


class StepFormula:
    """A formula of a step, read to its `expression`, which is defined on `domain`.

    `names`: those that it may use beside derivatives of H; `source`: what it is called in an error.
    Raises InputError.
    """

    def __init__(
        self, hamiltonian: Hamiltonian, formula: str, names: Sequence[str], source: str
    ) -> None:
        self._hamiltonian, self._names, self._source = hamiltonian, names, source
        self._coordinates = (*hamiltonian.coordinates, *names_of_time(hamiltonian))
        self._values: dict[sympy.Symbol, sympy.Expr] = {}  # of the calls, by their names
        self.domain = FormulaDomain.from_requirements(())
        self.expression = self._read(formula, 0)

    def _read(self, formula: str, depth: int) -> sympy.Expr:
        if depth > _MOST_NESTED:
            problem = f"has derivatives of H nested deeper than {_MOST_NESTED}"
            raise LimitError(self._source, formula, problem)
        text = self._replace_calls(formula, depth)
        names = [*self._names, *map(str, self._values)]
        expression, requirements = read(text, names, source=self._source)
        self.domain &= FormulaDomain.from_requirements(requirements).substitute(self._values)
        return expression.xreplace(self._values)

    def _replace_calls(self, formula: str, depth: int) -> str:
        """Return the formula with a name in place of each call."""
        if "H_" not in formula or len(formula) > MAX_LENGTH or not formula.isascii():
            return formula  # `read` says what is wrong
        line = " ".join(formula.replace("^", "**").split())
        try:
            tree = ast.parse(line, mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return formula  # `read` says what is wrong
        for call in reversed(_outermost_calls(tree, self._names)):
            value = self._differentiate(call, line, depth)
            name = symbol(f"H_value_{len(self._values)}")
            self._values[name] = value
            line = f"{line[: call.col_offset]}{name}{line[call.end_col_offset :]}"
        return line

    def _differentiate(self, call: ast.Call | ast.Name, line: str, depth: int) -> sympy.Expr:
        name = ast.unparse(getattr(call, "func", call))
        letters = name.removeprefix("H_")
        pattern = "|".join(sorted(self._coordinates, key=len, reverse=True))
        variables = re.findall(pattern, letters)
        if self._hamiltonian.energy is None or "".join(variables) != letters:
            allowed = ", ".join(f"H_{x}" for x in self._coordinates)
            raise self._error(line, f"{name} is no derivative of H; allowed: {allowed}")
        derivative = self._hamiltonian.expression.diff(*map(symbol, variables))
        needed = [x for x in self._coordinates if symbol(x) in derivative.free_symbols]
        texts = self._point(call, name, line, needed)
        return derivative.xreplace({symbol(x): self._read(y, depth + 1) for x, y in texts.items()})

    def _point(
        self, call: ast.Call | ast.Name, name: str, line: str, needed: Sequence[str]
    ) -> dict[str, str]:
        """Return the texts of the arguments, by their coordinates."""
        point: dict[str, str] = {}
        others = []
        arguments, keywords = getattr(call, "args", []), getattr(call, "keywords", [])
        pairs = [(_coordinate(x, self._coordinates), x) for x in arguments]
        for coordinate, node in [*pairs, *((x.arg, x.value) for x in keywords)]:
            text = line[node.col_offset : node.end_col_offset]
            if coordinate is None:
                others.append(text)
            elif coordinate in point or coordinate not in self._coordinates:
                problem = f"{coordinate} stands twice, or is no coordinate, in {name}(…)"
                raise self._error(line, problem)
            else:
                point[coordinate] = text
        missing = [x for x in needed if x not in point]
        if len(others) == len(missing) == 1:
            point[missing[0]] = others[0]
        elif others or missing:
            form = ", ".join(f"{x}=…" for x in needed)
            problem = f"{name} depends on {', '.join(needed) or 'nothing'}; write {name}({form})"
            raise self._error(line, problem)
        return point

    def _error(self, line: str, problem: str) -> InputError:
        return InputError(self._source, line, problem)


def names_of_time(hamiltonian: Hamiltonian) -> tuple[str, ...]:
    """Return t, by name, if H depends on it."""
    return ("t",) if hamiltonian.time_dependent else ()


def _outermost_calls(tree: ast.AST, names: Sequence[str]) -> list[ast.Call | ast.Name]:
    """Return the derivatives that stand in no other, in their order; also those without a point."""
    calls: list[ast.Call | ast.Name] = []
    waiting = [tree]  # no recursion: a sum of a thousand terms is a thousand levels deep
    while waiting:
        node = waiting.pop()
        name = getattr(getattr(node, "func", node), "id", "")
        if isinstance(node, ast.Call | ast.Name) and _CALLED.fullmatch(name) and name not in names:
            calls.append(node)
        else:
            waiting += ast.iter_child_nodes(node)
    return sorted(calls, key=lambda call: call.col_offset)


def _coordinate(node: ast.expr, coordinates: Sequence[str]) -> str | None:
    """Return the coordinate for which the argument is named, as q for q_next; None for others."""
    name = node.id if isinstance(node, ast.Name) else ""
    stem = name.partition("_")[0]
    return stem if stem in coordinates else None
