"""A Hamiltonian H(p, q), or H(p, q, t), with exact parameters.

In n degrees of freedom its coordinates are p1 … pn and q1 … qn. Derivatives along its flow are in
`verify.hamiltonians.canonical_field`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.algebra.embedding import MAX_TERMS, embed
from verify.algebra.expressions.formula_text import to_text
from verify.algebra.expressions.function_nodes import requirements_of_expression
from verify.algebra.expressions.monomials import names_in, reads_back
from verify.algebra.formula import MAX_DEPTH, MAX_LENGTH, parameter_name, parse, read, symbol
from verify.algebra.limits import substitute
from verify.algebra.ring import Poly, Ring, ring_from_record
from verify.arithmetic.exact import Number, rational, text
from verify.drawable import drawn_by
from verify.errors import InputError
from verify.hamiltonians.coordinates import PLANE, check_coordinates, coordinates_of
from verify.lazy_sympy import sympy
from verify.notebook import aligned_latex, cut, short_latex
from verify.structures import AREA, SYMPLECTIC, CanonicalForm


# Cached: every task of a report parses its Hamiltonian, one of a few.
@lru_cache(maxsize=64)
def _parse_formula(formula: str) -> Hamiltonian:
    """Return H with an expression whose text is read back as the same expression."""
    expression, requirements = read(formula, source="hamiltonian")
    hamiltonian = Hamiltonian(settle(expression, formula))
    text_domain = FormulaDomain.from_requirements(requirements) if requirements else EVERYWHERE
    is_implied = hamiltonian.domain & text_domain == hamiltonian.domain
    return hamiltonian if is_implied else replace(hamiltonian, text_domain=text_domain)


def settle(expression: sympy.Expr, formula: str, source: str = "hamiltonian") -> sympy.Expr:
    """Return an equal expression whose text is read back as the same expression: tasks, stored
    results and certificates have that text.

    `formula`: what was read from the `source`. It can be much shorter than the text: each time that
    this is read, sympy multiplies a number into a sum one level deeper.
    """
    # The loop ends at a fixed point, at which the text of the expression is read as the expression.
    for _ in range(MAX_DEPTH):
        read_again = expression
        if not reads_back(expression, MAX_LENGTH):
            read_again = parse(to_text(expression), source=f"{source}, written out")
        if read_again == expression:
            return expression
        expression = read_again
    raise InputError(source, formula, "is read otherwise each time that it is written out")


@lru_cache(maxsize=64)
def _with_values(hamiltonian: Hamiltonian, values: tuple[tuple[str, Fraction], ...]) -> Hamiltonian:
    result = replace(hamiltonian, values=values)
    result.domain  # noqa: B018 - raises InputError if H is not defined for the values
    return result


class _ReadAgain:
    """The expression of an H from a record: a descriptor that parses it when it is first read."""

    def __get__(self, owner: Hamiltonian | None, _: type) -> sympy.Expr:
        if owner is None:
            raise AttributeError  # the field has no default
        expression = vars(owner)["expression"] = parse(owner.formula, source="hamiltonian")
        return expression


@drawn_by("hamiltonians")
@dataclass(frozen=True, eq=False)
class Hamiltonian:
    """H(p, q) or H(p, q, t) as an exact expression, with values of some or all parameters.

    A parameter without a value stays a symbol. In `expression` all parameters are symbols; in
    `exact` the values stand in their places. `text_domain`: the domain of the text from which H was
    read, if it is smaller than that of the expression (√q·√q is q); else EVERYWHERE.
    """

    expression: sympy.Expr = _ReadAgain()
    values: tuple[tuple[str, Fraction], ...] = ()
    text_domain: FormulaDomain = EVERYWHERE
    _record: Mapping[str, Any] | None = field(default=None, init=False, repr=False)

    @classmethod
    def from_record(cls, record: Mapping[str, Any]) -> Hamiltonian:
        """Return H from its record (see `verify.hamiltonians.hamiltonian_store`); the expression is
        parsed when it is first used."""
        hamiltonian = cls.__new__(cls)
        vars(hamiltonian).update(
            formula=record["formula"],
            values=tuple((name, Fraction(value)) for name, value in record["values"]),
            parameters=tuple(record["parameters"]),
            coordinates=tuple(record["coordinates"]),
            time_dependent=record["time_dependent"],
            text_domain=EVERYWHERE,
            domain=EVERYWHERE,
            _record=record,
        )
        return hamiltonian

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Hamiltonian):
            return NotImplemented
        # Records are compared by their formulas, which determine the expressions, without sympy.
        if (self.values, self.text_domain) != (other.values, other.text_domain):
            return False
        if self._record and other._record:
            return self.formula == other.formula
        return bool(self.expression == other.expression)

    def __hash__(self) -> int:
        return hash((self.parameters, self.coordinates, self.values))

    def __reduce__(self) -> tuple[Any, ...]:
        return Hamiltonian, (self.expression, self.values, self.text_domain)

    @classmethod
    def parse(
        cls, formula: str, parameters: Mapping[str, Number | None] | None = None
    ) -> Hamiltonian:
        """Return H from a formula (see `verify.algebra.formula`) and parameter values; a parameter
        with None stays a symbol.

        Raises InputError for a bad formula, a bad value, a parameter that H does not have, or a
        name that is likely meant for a missing p or q.
        """
        if not isinstance(formula, str):  # the parser raises InputError
            parse(formula, source="hamiltonian")
        hamiltonian = _parse_formula(formula)
        if parameters is not None and not isinstance(parameters, Mapping):
            raise InputError("parameters", parameters, "is not a mapping of names to values")
        result = hamiltonian.with_values(parameters or {})
        check_coordinates(formula, hamiltonian.expression, result.symbols)
        return result

    def with_values(self, parameters: Mapping[str, Number | None]) -> Hamiltonian:
        """Return the same H with these parameter values instead of its present ones.

        `parameters`: exact numbers, or texts of them, by name. A parameter with None, or without an
        item, has no value in the result. Raises InputError for a name that H does not have, a bad
        value, and values for which H is not defined.
        """
        numbers = {}
        for name, value in parameters.items():
            if parameter_name(name) not in self.parameters:
                names = ", ".join(self.parameters) or "none"
                raise InputError("parameter", name, f"H has no such parameter; it has: {names}")
            if value is not None:
                numbers[name] = rational(value, f"parameter {name}")
        if not numbers and not self.values:
            return self
        return _with_values(self, tuple(sorted(numbers.items())))

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """The names of all parameters, with or without a value."""
        return tuple(sorted(names_in(self.expression) - {*self.coordinates, "t"}))

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """The coordinates p and q, or p1 … pn, q1 … qn."""
        return coordinates_of(names_in(self.expression))

    @property
    def planar(self) -> bool:
        """True if the coordinates are p and q."""
        return self.coordinates == PLANE

    @property
    def structure(self) -> CanonicalForm:
        """The structure that a canonical step preserves."""
        return AREA if self.planar else SYMPLECTIC

    def check_planar(self) -> None:
        """Raise InputError unless the coordinates are p and q."""
        if not self.planar:
            names = ", ".join(self.coordinates)
            problem = f"is of {names}; what is asked for takes p and q, one degree of freedom"
            raise InputError("hamiltonian", self.formula, problem)

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom."""
        return len(self.coordinates) // 2

    def halves(self, z: Sequence[Any]) -> tuple[Any, Any]:  # Any: an element of z, or a slice
        """Return p and q of a point z: its two elements in the plane; in n degrees of freedom its
        two halves."""
        return (z[0], z[1]) if self.planar else (z[: self.degrees], z[self.degrees :])

    @cached_property
    def time_dependent(self) -> bool:
        """True if t is in `exact`."""
        return "t" in names_in(self.exact)

    @property
    def symbols(self) -> tuple[str, ...]:
        """The names of the parameters without a value."""
        values = dict(self.values)
        return tuple(name for name in self.parameters if name not in values)

    @cached_property
    def exact(self) -> sympy.Expr:
        """The expression with the values in place of their symbols; InputError if it is not defined
        for them."""
        return self.substitute_values(self.expression)

    @property
    def has_energy(self) -> bool:
        """True if there is an H; it is answered without the expression."""
        return True

    @property
    def energy(self) -> sympy.Expr | None:
        """The expression `exact`; None for a system without a Hamiltonian."""
        return self.exact

    @cached_property
    def domain(self) -> FormulaDomain:
        """The conditions under which `exact` is smooth, and the text of H is defined."""
        return FormulaDomain.from_requirements(
            requirements_of_expression(self.exact, smooth=True)
        ) & self.text_domain.substitute(self.value_substitutions)

    @property
    def domain_moves(self) -> bool:
        """True if `domain` has conditions on coordinates or t, so that a step may leave it."""
        return bool(self.domain.names & {*self.coordinates, "t"})

    @property
    def value_substitutions(self) -> dict[sympy.Symbol, sympy.Rational]:
        """The parameters' values, by symbol."""
        return {symbol(n): sympy.Rational(v.numerator, v.denominator) for n, v in self.values}

    def substitute_values(self, expression: sympy.Expr) -> sympy.Expr:
        """Return an expression with H's values in place of symbols, under the parser's limits."""
        values_text = ", ".join(f"{n}={text(v)}" for n, v in self.values)
        return substitute(expression, self.value_substitutions, values_text)

    @cached_property
    def formula(self) -> str:
        """The expression as a text that `Hamiltonian.parse` reads back to the same expression."""
        return to_text(self.expression)

    def __repr__(self) -> str:
        values = (f", {name} = {text(value)}" for name, value in self.values)
        return f"{type(self).__name__}({cut(self.formula)}{''.join(values)})"

    def _repr_latex_(self) -> str:
        """Return the system with parameters as symbols, and the values of those that have one."""
        lines = self._latex_lines
        for name, value in self.values:
            lines.append(f"{sympy.latex(symbol(name))} &= {sympy.latex(sympy.Rational(value))}")
        return aligned_latex(lines)

    @property
    def _latex_lines(self) -> list[str]:
        return [f"H &= {short_latex(sympy.latex(self.expression))}"]

    @property
    def texts(self) -> dict[str, Any]:  # Any: arguments of models, which check them
        """The formula and parameter values as texts, under their keys in results."""
        return {
            "hamiltonian": self.formula,
            "parameters": {name: text(value) for name, value in self.values},
        }

    def gradient(self) -> Callable[..., tuple[Any, Any]]:  # Any: floats, or lists of them
        """Return (p, q) ↦ (H_p, H_q) in Python floats, for a user's step function; (p, q, t) ↦
        (H_p, H_q) if H depends on time.

        In n degrees of freedom p and q are sequences of n floats, H_p and H_q lists.

        Every operation is rounded, so the last digits are not known. The function raises what
        `math` raises: OverflowError beyond float's range, ValueError or ZeroDivisionError where H
        is not defined. Raises InputError if a parameter has no value.
        """
        if self.symbols:
            raise InputError("parameter", self.symbols[0], "has no value; a gradient needs one")
        coordinates = [symbol(name) for name in self.coordinates]
        arguments, derivatives = map(
            self.halves, (coordinates, [self.exact.diff(x) for x in coordinates])
        )
        time = (symbol("t"),) if self.time_dependent else ()
        function: Callable[..., tuple[Any, Any]]
        function = sympy.lambdify((*arguments, *time), derivatives, modules="math", cse=True)
        return function

    def with_symbols(self) -> Hamiltonian:
        """Return H with its parameters as symbols, except those with the value 0.

        Kernels are compiled for it: the values are their run-time arguments.
        """
        return self._with_symbols

    @cached_property
    def _with_symbols(self) -> Hamiltonian:
        if self._record and not self.values:
            return self
        if self._record and self._record["generic"]:
            return Hamiltonian.from_record(self._record["generic"])
        # With a value of 0 whole terms vanish, and the kernel is faster; all others share a kernel.
        zeros = {symbol(n): sympy.S.Zero for n, v in self.values if v == 0}
        return Hamiltonian(self.expression.subs(zeros))

    def embed_in_ring(
        self, *expressions: sympy.Expr, most_terms: int = MAX_TERMS
    ) -> tuple[Ring, Poly, list[Poly]]:
        """Return a ring, `exact` as an element of it, and the expressions as elements.

        Its variables: the coordinates, h, t if H has it, the parameters without a value, and all
        other symbols of the expressions. Raises InputError if an element has more than `most_terms`
        terms, or is not defined.
        """
        if self._record and not expressions and most_terms == MAX_TERMS:
            return *ring_from_record(self._record["ring"]), []
        time = ("t",) if self.time_dependent else ()
        variables = (*self.coordinates, "h", *time, *self.symbols)

        symbols = {x.name for expression in expressions for x in expression.free_symbols}
        variables = (*variables, *sorted(symbols.difference(variables)))
        ring, (energy, *elements) = embed([self.exact, *expressions], variables, most_terms)
        return ring, energy, elements
