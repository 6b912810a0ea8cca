"""A differential ring: polynomials in variables and generators, with relations and derivatives.

`verify.algebra.ring` describes its purpose, and decides whether an element is zero. A place is the
position of a generator among all generators of the ring; variables are generators too.
"""

from __future__ import annotations

from collections.abc import Sequence

from verify.algebra.identities.polynomials import Generator, Poly, Polynomials, places_in, split
from verify.lazy_sympy import sympy

_SPARE_GENERATORS = 6  # generators that later calls to `inverse` may still add


class RingFullError(Exception):
    """More generators are needed than the ring has room for."""


class DifferentialRing(Polynomials):
    """Polynomials in the given variables, with room for `room` generators.

    `verify.algebra.ring.Ring` extends it by the decision whether an element is zero, by division
    and by text.
    """

    def __init__(self, variables: Sequence[str], room: int, spare: int = _SPARE_GENERATORS) -> None:
        super().__init__(variables, room + spare)
        self.variables, self.room = tuple(variables), room + spare
        self.generators: list[Generator] = [
            Generator(self.room + k, "variable", name=name) for k, name in enumerate(self.variables)
        ]
        self._by_index = {g.index: g for g in self.generators}
        self._gradients: dict[int, dict[str, Poly]] = {}
        self._inside: dict[int, list[int]] = {}
        self.expressions: dict[int, sympy.Expr] = {}  # a cache: index of a generator → expression

    # -- elements -----------------------------------------------------------------------------

    def diff(self, x: Poly, name: str) -> Poly:
        """Return ∂x/∂name in normal form, by the chain rule over the generators."""
        total = x.derivative(self.places[name])
        for index in self._functions_in(x):
            total += x.derivative(index) * self._partial(index, name)
        return self.reduce(total)

    def _functions_in(self, x: Poly) -> list[int]:
        """Return the indices of the generators in x that are no variables; those in arguments do
        not count."""
        if len(self.generators) == len(self.variables):
            return []
        # Variables have the places from `room` on, other generators those before.
        return [index for index, power in enumerate(x.degrees()[: self.room]) if power > 0]

    def in_variables(self, x: Poly) -> bool:
        """Return True if x is a polynomial in the variables alone."""
        return not self._functions_in(x)

    def _partial(self, index: int, name: str) -> Poly:
        """Return the partial derivative of a generator."""
        return self.gradient(index).get(name, self.zero)

    def terms_of_diff(self, x: Poly, name: str) -> int:
        """Return a bound on the number of terms of ∂x/∂name, without computing it."""
        total = len(x)
        for index in self._functions_in(x):
            total += len(x.derivative(index)) * len(self._partial(index, name))
        return total

    def generators_in(self, *elements: Poly) -> list[Generator]:
        """Return the generators that the elements depend on, arguments included, oldest first."""
        visited: set[int] = set()
        stack = [index for x in elements for index in places_in(x)]
        while stack:
            index = stack.pop()
            if index not in visited:
                visited.add(index)
                stack += self._inside_of(index)
        return [g for g in self.generators if g.index in visited]

    def _inside_of(self, index: int) -> list[int]:
        """Return the indices of the generators in a generator's argument."""
        if index not in self._inside:
            argument = self._by_index[index].argument
            self._inside[index] = [] if argument is None else places_in(argument)
        return self._inside[index]

    def depends(self, x: Poly, name: str) -> bool:
        """Return True if the variable is in x, or in an argument of its generators."""
        place, visited, stack = self.places.get(name), set[int](), places_in(x)
        while stack:
            index = stack.pop()
            if index == place:
                return True
            if index not in visited:
                visited.add(index)
                stack += self._inside_of(index)
        return False

    def powers(self, x: Poly, name: str) -> dict[int, Poly]:
        """Return the coefficients of x by the powers of one variable: {power: coefficient ≠ 0}.

        No generator in x may depend on that variable.
        """
        return split(x, self.places[name])

    # -- generators ---------------------------------------------------------------------------

    def add(self, kind: str, argument: Poly | None = None, degree: int = 1) -> Poly:
        """Add a generator; its relation and gradient are set by `relate` and `set_gradient`."""
        if not self.free:
            raise RingFullError(f"more than {self.room} functions and denominators are needed")
        index = self.reserve_place()
        generator = Generator(index, kind, argument, degree)
        self.generators.append(generator)
        self._by_index[index] = generator
        return self.gens[index]

    def find(self, kind: str, argument: Poly | None, degree: int = 1) -> Poly | None:
        """Return the generator of that kind for that argument, or None if there is none."""
        for g in self.generators:
            if g.kind == kind and g.degree == degree and g.argument == argument:
                return self.gens[g.index]
        return None

    def set_gradient(self, generator: Poly, outer: Poly, inner: Poly) -> None:
        """Set the gradient of the generator by the chain rule d generator = outer · d inner."""
        partials = ((name, self.diff(inner, name)) for name in self.variables)
        gradient = {
            name: self.multiply(outer, part) for name, part in partials if not part.is_zero()
        }
        self.set_partials(generator, gradient)

    def set_partials(self, generator: Poly, gradient: dict[str, Poly]) -> None:
        """Set the generator's partial derivatives that are not 0, by variable."""
        self._gradients[self.gens.index(generator)] = gradient

    def gradient(self, index: int) -> dict[str, Poly]:
        """Return the generator's partial derivatives that are not 0, by variable."""
        return self._gradients.get(index, {})
