"""A ring's polynomials as a certificate's checker takes them: nothing is reduced.

So what has to be zero is the same polynomial here and there.
"""

from verify.algebra.generator import terms_of
from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.proof.certificates.by_coefficients import terms

_KINDS = ("sin", "cos", "exp", "inverse")


class Plain:
    """A ring's polynomials with derivatives by the coordinates and t by the chain rule, and nothing
    reduced."""

    def __init__(self, ring: Ring, coordinates: tuple[str, ...]) -> None:
        self.ring, self.coordinates = ring, coordinates
        self.variables = (*coordinates, *("t",) * ("t" in ring.variables))
        self.names = {
            g.index: g.name if g.kind == "variable" else f"#{g.index}" for g in ring.generators
        }
        made = [g for g in ring.generators if g.kind != "variable"]
        for g in made:
            if g.kind not in _KINDS:
                raise InputError(
                    "hamiltonian",
                    ring.text(ring.context.gens()[g.index]),
                    "no certificate: it takes sin, cos, exp, denominators",
                )
        self.functions = [[self.names[g.index], g.kind, terms(g.inner, self.names)] for g in made]
        self._images: dict[int, dict[str, Poly]] = {}
        gens = ring.context.gens()
        for g in made:
            own = gens[g.index]
            partner = {"sin": "cos", "cos": "sin"}.get(g.kind)
            side = (partner and ring.find(partner, g.inner)) or ring.zero
            slope = {"sin": side, "cos": -side, "exp": own, "inverse": -(own**2)}[g.kind]
            self._images[g.index] = {by: slope * self.diff(g.inner, by) for by in self.variables}

    def diff(self, x: Poly, by: str) -> Poly:
        total = x.derivative(self.ring.room + self.ring.variables.index(by))
        degrees = x.degrees()
        for index, image in self._images.items():
            if degrees[index] > 0:
                total += x.derivative(index) * image[by]
        return total

    def without_constants(self, x: Poly, variables: tuple[str, ...] = ()) -> Poly:
        """Without the terms that depend on none of these variables, or of the coordinates."""
        variables = variables or self.coordinates
        terms = {m: c for m, c in terms_of(x) if any(self._has(m, by) for by in variables)}
        return self.ring.context.from_dict(terms)

    def _has(self, monomial: tuple[int, ...], by: str) -> bool:
        term = self.ring.context.from_dict({monomial: 1})
        return not self.diff(term, by).is_zero()

    def cofactors(self, x: Poly) -> dict[str, list[list[str]]]:
        """By which Σ cofactor·relation is x; InputError where reducing does not end at 0."""
        found: dict[int, Poly] = {}
        for index, power, relation in reversed(self.ring.relations):
            if x.degrees()[index] >= power:
                quotient, x = divmod(x, relation)
                found[index] = found.get(index, self.ring.zero) + quotient
        if not x.is_zero():
            raise InputError("proof", str(x)[:60], "no certificate: zero is not seen by reducing")
        return {self.names[index]: terms(c, self.names) for index, c in found.items()}
