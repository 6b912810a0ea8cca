"""A planar Hamiltonian H(p, q) with exact parameters, and its Lie derivative."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

import sympy

from verify.errors import InputError
from verify.exact import Exact, rational, text
from verify.formula import parameter_name, parse, symbol, to_text
from verify.generators import MAX_TERMS, embed
from verify.ring import Poly, Ring
from verify.substitution import substitute

_MOST_KEPT = 2000  # terms of a bracket, beyond which it is made anew for each scheme


# A report asks for the same few Hamiltonians thousands of times: once for every task.
@lru_cache(maxsize=64)
def _of_formula(formula: str) -> "Hamiltonian":
    return Hamiltonian(parse(formula, source="hamiltonian"))


@lru_cache(maxsize=64)
def _with_values(expression: sympy.Expr, values: tuple[tuple[str, Fraction], ...]) -> "Hamiltonian":
    result = Hamiltonian(expression, values)
    result.exact  # noqa: B018 - refuses values for which H is not defined
    return result


@dataclass(frozen=True)
class Hamiltonian:
    """H(p, q) as an exact expression, with the values of those parameters that have one.

    A parameter without a value stays a symbol. `expression` holds all parameters as symbols;
    `exact` has the values put in.
    """

    expression: sympy.Expr
    values: tuple[tuple[str, Fraction], ...] = ()

    @classmethod
    def parse(
        cls, formula: str, parameters: Mapping[str, Exact | None] | None = None
    ) -> "Hamiltonian":
        """From a formula (see `verify.formula`) and parameter values; None leaves a symbol.

        Raises InputError for a bad formula, a bad value, or a parameter that H does not have.
        """
        if not isinstance(formula, str):  # the parser says so
            parse(formula, source="hamiltonian")
        made = _of_formula(formula)
        if parameters is not None and not isinstance(parameters, Mapping):
            raise InputError("parameters", parameters, "is not a mapping of names to values")
        return made.with_values(parameters or {})

    def with_values(self, parameters: Mapping[str, Exact | None]) -> "Hamiltonian":
        """The same H with these parameter values instead of its present ones."""
        given = {}
        for name, value in parameters.items():
            if parameter_name(name) not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise InputError("parameter", name, f"H has no such parameter; it has: {known}")
            if value is not None:
                given[name] = rational(value, f"parameter {name}")
        return _with_values(self.expression, tuple(sorted(given.items())))

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """All parameter names, with or without a value."""
        return tuple(
            sorted(s.name for s in self.expression.free_symbols if s.name not in ("p", "q"))
        )

    @property
    def symbols(self) -> tuple[str, ...]:
        """The names of the parameters without a value."""
        given = dict(self.values)
        return tuple(name for name in self.parameters if name not in given)

    @cached_property
    def exact(self) -> sympy.Expr:
        """H with the values put in; InputError where it is not defined for them."""
        return self.put_in(self.expression)

    def put_in(self, expression: sympy.Expr) -> sympy.Expr:
        """Any expression with H's parameter values put in, under the parser's limits."""
        put = {symbol(n): sympy.Rational(v.numerator, v.denominator) for n, v in self.values}
        shown = ", ".join(f"{n}={text(v)}" for n, v in self.values)
        return substitute(expression, put, shown)

    @cached_property
    def formula(self) -> str:
        """The expression as text that `parse` reads back."""
        return to_text(self.expression)

    @property
    def written(self) -> dict[str, Any]:
        """Its formula and parameter values as text, by the names that results give them."""
        return {
            "hamiltonian": self.formula,
            "parameters": {name: text(value) for name, value in self.values},
        }

    def generic(self) -> "Hamiltonian":
        """H with its parameters as symbols, but for those of value 0, whose terms vanish.

        This is what a kernel is compiled for: the other values are its run-time arguments.
        """
        zeros = {symbol(n): sympy.S.Zero for n, v in self.values if v == 0}
        return Hamiltonian(self.expression.subs(zeros))

    def field(
        self, *others: sympy.Expr, most_terms: int = MAX_TERMS
    ) -> tuple["VectorField", list[Poly]]:
        """The vector field of `exact`, and the other expressions as elements of its ring."""
        if not others and most_terms == MAX_TERMS:
            return _field_of(self), []
        return _embedded(self, others, most_terms)


def _embedded(
    hamiltonian: Hamiltonian, others: Sequence[sympy.Expr], most_terms: int
) -> tuple["VectorField", list[Poly]]:
    variables = ("p", "q", "h", *hamiltonian.symbols)
    ring, elements = embed([hamiltonian.exact, *others], variables, most_terms)
    return VectorField.of(ring, elements[0]), elements[1:]


# Several schemes are proved for one H after another: what they share is made once. Few, since a
# field keeps what was derived along it.
@lru_cache(maxsize=8)
def _field_of(hamiltonian: Hamiltonian) -> "VectorField":
    return _embedded(hamiltonian, (), MAX_TERMS)[0]


@dataclass(frozen=True)
class VectorField:
    """p' = −H_q, q' = H_p (Eq. 1) in a ring; X = H_p ∂_q − H_q ∂_p is its Lie derivative."""

    ring: Ring
    h_p: Poly
    h_q: Poly

    @classmethod
    def of(cls, ring: Ring, hamiltonian: Poly) -> "VectorField":
        return cls(ring, ring.diff(hamiltonian, "p"), ring.diff(hamiltonian, "q"))

    def derive(self, y: Poly) -> Poly:
        """X y, the derivative of y along the flow."""
        ring = self.ring
        return ring.reduce(self.h_p * ring.diff(y, "q") - self.h_q * ring.diff(y, "p"))

    def powers(self, y: Poly, most: int) -> Sequence[Poly]:
        """[y, X y, …, X^most y]."""
        result = [y]
        for _ in range(most):
            result.append(self.derive(result[-1]))
        return result

    @cached_property
    def _kept(self) -> "_Kept":
        return _Kept(self)

    def power(self, name: str, n: int) -> Poly:
        """Xⁿ y of y = p or q, made once."""
        return self._kept.power(name, n)

    def along(self, name: str, most: int) -> Sequence[Poly]:
        """[y, X y, …, X^most y] of y = p or q, each made once."""
        return [self._kept.power(name, n) for n in range(most + 1)]

    def bracket_of_powers(self, k: int, m: int) -> Poly:
        """∂(Xᵏp, Xᵐq)/∂(p, q)."""
        return self._kept.bracket(k, m)

    def truncated(self, eta: int) -> tuple[Poly, Poly]:
        """Σ hⁿ/n! Xⁿp and Σ hⁿ/n! Xⁿq, n = 0 … η."""
        return self._kept.truncated(eta)

    def truncated_at(self, p_next: Poly, q_next: Poly) -> int | None:
        """The η whose `truncated` these very objects are; None for any other elements."""
        return self._kept.truncated_at(p_next, q_next)

    def bracket(self, x: Poly, y: Poly) -> Poly:
        """∂(x, y)/∂(p, q)."""
        diff, multiply = self.ring.diff, self.ring.multiply
        return multiply(diff(x, "p"), diff(y, "q")) - multiply(diff(x, "q"), diff(y, "p"))

    def separable(self) -> bool:
        """Whether H = T(p) + V(q): the mixed derivative H_pq is the zero function."""
        return self.ring.decide(self.ring.diff(self.h_p, "q")).zero is True


class _Kept:
    """The powers of X on p and q along a field, with their gradients and brackets, each made once.

    By keys rather than in lists, so that two threads may make the same one.
    """

    def __init__(self, field: VectorField) -> None:
        self.field = field
        self._powers: dict[tuple[str, int], Poly] = {}
        self._gradients: dict[tuple[str, int], tuple[Poly, Poly]] = {}
        self._brackets: dict[tuple[int, int], Poly] = {}
        self._truncated: dict[int, tuple[Poly, Poly]] = {}

    def power(self, name: str, n: int) -> Poly:
        if n == 0:
            return self.field.ring.variable(name)
        if (name, n) not in self._powers:
            y_p, y_q = self.gradient(name, n - 1)
            next_one = self.field.h_p * y_q - self.field.h_q * y_p
            self._powers[name, n] = self.field.ring.reduce(next_one)
        return self._powers[name, n]

    def gradient(self, name: str, n: int) -> tuple[Poly, Poly]:
        if (name, n) not in self._gradients:
            diff, y = self.field.ring.diff, self.power(name, n)
            self._gradients[name, n] = diff(y, "p"), diff(y, "q")
        return self._gradients[name, n]

    def bracket(self, k: int, m: int) -> Poly:
        if (k, m) in self._brackets:
            return self._brackets[k, m]
        (x_p, x_q), (y_p, y_q) = self.gradient("p", k), self.gradient("q", m)
        found = x_p * y_q - x_q * y_p
        if len(found) <= _MOST_KEPT:
            self._brackets[k, m] = found
        return found

    def truncated(self, eta: int) -> tuple[Poly, Poly]:
        if eta not in self._truncated:
            ring = self.field.ring
            below = self.truncated(eta - 1) if eta else (ring.zero, ring.zero)
            factor = ring.variable("h") ** eta / math.factorial(eta)
            p, q = (x + factor * self.power(name, eta) for x, name in zip(below, "pq", strict=True))
            self._truncated[eta] = p, q
        return self._truncated[eta]

    def truncated_at(self, p_next: Poly, q_next: Poly) -> int | None:
        for eta, (p, q) in self._truncated.items():
            if p is p_next and q is q_next:
                return eta
        return None
