"""A system without a Hamiltonian: z' = f(z, t), a formula for each coordinate.

It is written as `u_dot = u*(v - 2); v_dot = v*(1 - u)`, with names of one's own, any number of
coordinates, in their order, and parameters.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from keyword import iskeyword
from typing import Any

from verify.algebra.domain import FormulaDomain
from verify.algebra.embedding import MAX_TERMS, embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import FUNCTIONS, read, symbol
from verify.algebra.ring import Poly, Ring
from verify.arithmetic.exact import Number
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian, settle
from verify.lazy_sympy import sympy
from verify.notebook import short_latex
from verify.structures import PLAIN_VOLUME, CanonicalForm

_LINE = re.compile(r"\s*([A-Za-z][A-Za-z0-9_]*)_dot\s*=(.*)", re.DOTALL)
_MAX_COORDINATES = 128
_RESERVED = frozenset({"h", "t", "pi", *FUNCTIONS})
EXAMPLE = "u_dot = u*(v - 2); v_dot = v*(1 - u)"


def are_equations(text: str) -> bool:
    """Return True if a text is meant as equations and not as the formula of an H."""
    return isinstance(text, str) and "_dot" in text and "=" in text


@dataclass(frozen=True, eq=False, repr=False)
class Equations(Hamiltonian):
    """Equations z' = f(z, t): `expression` is the tuple of f's components, `names` are those of z.

    It takes the place of a Hamiltonian wherever only the field counts.
    """

    names: tuple[str, ...] = ()

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Equations)
            and (self.names, self.values) == (other.names, other.values)
            and bool(self.expression == other.expression)
            and self.text_domain == other.text_domain
        )

    def __hash__(self) -> int:
        return hash((self.names, self.parameters, self.values))

    def __reduce__(self) -> tuple[Any, ...]:
        return Equations, (self.expression, self.values, self.text_domain, self.names)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The coordinates, in the order of their equations."""
        return self.names

    @property
    def planar(self) -> bool:
        """False: p and q of the plane are those of a Hamiltonian."""
        return False

    @property
    def has_energy(self) -> bool:
        """False: there is no Hamiltonian."""
        return False

    @property
    def energy(self) -> None:
        """None: there is no Hamiltonian."""
        return None

    @property
    def structure(self) -> CanonicalForm:
        """The structure that is judged by default: volume, which every field may keep."""
        return PLAIN_VOLUME

    @cached_property
    def formula(self) -> str:
        """The equations as a text that is read back to the same ones."""
        pairs = zip(self.names, self.expression.args, strict=True)
        return "; ".join(f"{name}_dot = {to_text(x)}" for name, x in pairs)

    @property
    def _latex_lines(self) -> list[str]:
        pairs = zip(self.names, self.expression.args, strict=True)
        latex = sympy.latex
        return [rf"\dot{{{latex(symbol(n))}}} &= {short_latex(latex(x))}" for n, x in pairs]

    def halves(self, z: Sequence[Any]) -> tuple[Any, Any]:
        """Raise InputError: the coordinates are no p and q."""
        raise InputError("field", self.formula, "has no p and q; what is asked for takes an H")

    def gradient(self) -> Callable[..., tuple[Any, Any]]:
        """Raise InputError: there is no H."""
        self.halves(())
        raise AssertionError

    @cached_property
    def _with_symbols(self) -> Equations:
        zeros = {symbol(n): sympy.S.Zero for n, v in self.values if v == 0}
        return Equations(sympy.Tuple(*(x.subs(zeros) for x in self.expression)), names=self.names)

    def embed_slopes(
        self, *expressions: sympy.Expr, most_terms: int = MAX_TERMS
    ) -> tuple[Ring, list[Poly], list[Poly]]:
        """Return a ring, the components of f as elements of it, and the expressions as elements.

        Its variables are those of `Hamiltonian.embed_in_ring`, which says what is raised.
        """
        time = ("t",) if self.time_dependent else ()
        variables = (*self.coordinates, "h", *time, *self.symbols)
        symbols = {x.name for expression in expressions for x in expression.free_symbols}
        variables = (*variables, *sorted(symbols.difference(variables)))
        ring, elements = embed([*self.exact, *expressions], variables, most_terms)
        size = len(self.names)
        return ring, elements[:size], elements[size:]


def read_system(
    text: str, parameters: Mapping[str, Number | None] | None = None
) -> Hamiltonian | Equations:
    """Return the H of a formula, or equations `u_dot = …; v_dot = …`, with parameter values.

    Raises InputError, one line, as `Hamiltonian.parse` does.
    """
    if not are_equations(text):
        return Hamiltonian.parse(text, parameters)
    equations = _read_equations(text)
    if parameters is not None and not isinstance(parameters, Mapping):
        raise InputError("parameters", parameters, "is not a mapping of names to values")
    result = equations.with_values(parameters or {})
    assert isinstance(result, Equations)  # noqa: S101 - values leave the class as it is
    return result


@lru_cache(maxsize=64)
def _read_equations(text: str) -> Equations:
    formulas: dict[str, str] = {}
    for line in text.strip().rstrip(";").split(";"):
        match = _LINE.fullmatch(line)
        if match is None:
            raise InputError("field", line.strip(), f"is no equation; write {EXAMPLE}")
        name, formula = match.groups()
        if name in formulas:
            raise InputError("field", f"{name}_dot", "stands twice")
        if name in _RESERVED or iskeyword(name) or name.endswith("_dot"):
            raise InputError("field", f"{name}_dot", f"{name} is no name of a coordinate")
        formulas[name] = formula.strip()
    if not 1 <= len(formulas) <= _MAX_COORDINATES:
        problem = f"has {len(formulas)} coordinates; allowed: 1 … {_MAX_COORDINATES}"
        raise InputError("field", text, problem)
    expressions, requirements = [], []
    for name, formula in formulas.items():
        expression, needed = read(formula, source=f"{name}_dot")
        for other in expression.free_symbols:
            if other.name.removesuffix("_dot") in formulas and other.name not in formulas:
                raise InputError(f"{name}_dot", formula, f"has {other.name}; write its formula")
        expressions.append(settle(expression, formula, f"{name}_dot"))
        requirements += needed
    equations = Equations(sympy.Tuple(*expressions), names=tuple(formulas))
    text_domain = FormulaDomain.from_requirements(requirements)
    implied = not requirements or equations.domain & text_domain == equations.domain
    return equations if implied else replace(equations, text_domain=text_domain)
