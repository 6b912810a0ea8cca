"""One part of a step map in closed form or in stages: (p, q) → (p', q'), its Jacobian and its ΔJ.

ΔJ of a substep is written with its increments u = p' − p, v = q' − q as
u_p + v_q + u_p v_q − u_q v_p, in which nothing cancels where it is in closed form.
"""

from dataclasses import dataclass
from functools import cached_property

from verify.algebra.ring import Poly, Ring
from verify.algebra.series.power_series import Derivatives, Series, at_moved
from verify.hamiltonians.vector_field import VectorField
from verify.schemes.composition import arguments
from verify.schemes.conditions import Condition


@dataclass(frozen=True)
class Substep:
    """(p, q) → (p', q') as elements of the ring of the Hamiltonian's vector field.

    `conditions`: what is known exactly to suffice for ΔJ ≡ 0, for every H, where all of it holds;
    for a map that is given by equations, whose ΔJ the ring does not decide.
    """

    field: VectorField
    p_next: Poly
    q_next: Poly
    conditions: tuple[Condition, ...] = ()

    @property
    def ring(self) -> Ring:
        """The ring of p', q' and the field."""
        return self.field.ring

    @property
    def increments(self) -> tuple[Poly, Poly]:
        """p' − p and q' − q."""
        return (self.p_next - self.ring.variable("p"), self.q_next - self.ring.variable("q"))

    @cached_property
    def jacobian(self) -> tuple[Poly, Poly, Poly, Poly]:
        """∂p'/∂p, ∂p'/∂q, ∂q'/∂p, ∂q'/∂q."""
        diff = self.ring.diff
        return (
            diff(self.p_next, "p"),
            diff(self.p_next, "q"),
            diff(self.q_next, "p"),
            diff(self.q_next, "q"),
        )

    @property
    def staged(self) -> bool:
        """Whether it is made from stages that have names; see `verify.schemes.stages`."""
        return any(g.kind == "stage" for g in self.ring.generators_in(self.p_next, self.q_next))

    @cached_property
    def implicit(self) -> bool:
        """Whether it is given by equations; see `verify.algebra.implicit_unknowns`."""
        return any(g.kind == "solved" for g in self.ring.generators_in(self.p_next, self.q_next))

    @cached_property
    def delta_j(self) -> Poly:
        """ΔJ = det J − 1 in normal form, written so that the constant 1 never occurs in it."""
        a, u_q, v_p, d = self.jacobian
        u_p, v_q = a - 1, d - 1
        if self.staged:
            u_p, u_q, v_p, v_q = map(self.ring.named, (u_p, u_q, v_p, v_q))
        return self.ring.reduce(u_p + v_q + u_p * v_q - u_q * v_p)

    @property
    def length(self) -> int:
        """How many terms there are in all its parts."""
        pair = self.p_next, self.q_next
        return sum(map(len, [*pair, *arguments(self.ring, *pair)]))

    @property
    def terms_of_delta_j(self) -> int:
        """A bound of the number of terms that ΔJ has when it is written out."""
        bound = self.ring.terms_of_diff
        u_p, u_q = (bound(self.p_next, name) for name in ("p", "q"))
        v_p, v_q = (bound(self.q_next, name) for name in ("p", "q"))
        return u_p + v_q + u_p * v_q + u_q * v_p

    @cached_property
    def terms(self) -> tuple[dict[int, Poly], dict[int, Poly]] | None:
        """The coefficients in h of p' and q'; None where the map is no polynomial in h."""
        ring, pair = self.ring, (self.p_next, self.q_next)
        if self._eta is not None:
            return self.field.taylor("p", self._eta), self.field.taylor("q", self._eta)
        if h_inside(ring, *pair):
            return None
        return ring.powers(pair[0], "h"), ring.powers(pair[1], "h")

    @cached_property
    def _eta(self) -> int | None:
        """η where the map is the flow's Taylor polynomial to h^η that the field itself made."""
        return self.field.truncated_at(self.p_next, self.q_next)

    @cached_property
    def _gradients(self) -> tuple[dict[int, Poly], ...]:
        """The entries of J by their coefficients in h, of a map that is a polynomial in h."""
        assert self.terms is not None  # noqa: S101 - the caller looks at `degree`
        diff = self.ring.diff
        return tuple(
            {n: diff(x, name) for n, x in terms.items()}
            for terms in self.terms
            for name in ("p", "q")
        )

    @property
    def degree(self) -> int | None:
        """A bound on the degree of ΔJ in h; None where the map is no polynomial in h."""
        if self.terms is None:
            return None
        return 2 * max(max(part, default=0) for part in self.terms)

    def coefficient(self, n: int) -> Poly:
        """The coefficient of hⁿ in ΔJ, of a map that is a polynomial in h.

        By convolution of the coefficients of p' and q', as det J is the bracket of p' and q': the
        orders of a high scheme's ΔJ that vanish are seen without the thousands of terms of those
        that do not.
        """
        if self._eta is not None:
            return self.field.delta_j(n, self._eta)
        if n not in self._coefficients:
            total = -self.ring.one if n == 0 else self.ring.zero
            for k in range(n + 1):
                total += self._bracket(k, n - k)
            self._coefficients[n] = self.ring.reduce(total)
        return self._coefficients[n]

    @cached_property
    def _coefficients(self) -> dict[int, Poly]:
        return {}

    def _bracket(self, k: int, m: int) -> Poly:
        """∂(x, y)/∂(p, q) of the coefficients x of hᵏ in p' and y of hᵐ in q'."""
        x_p, x_q, y_p, y_q = self._gradients
        if k not in x_p or m not in y_p:
            return self.ring.zero
        return x_p[k] * y_q[m] - x_q[k] * y_p[m]

    def taylor(self, p: Series, q: Series) -> tuple[Series, Series] | None:
        """The substep's Taylor series in h at the point (p, q) + O(h) that is given by its series.

        None where the map is no polynomial in h, or does not begin with (p, q).
        """
        ring, start = self.ring, [self.ring.variable(name) for name in ("p", "q")]
        if self.terms is None:
            return None
        moves = [
            (name, x - Series.of(ring, [y], x.most))
            for name, x, y in zip(("p", "q"), (p, q), start, strict=True)
        ]
        result = []
        for powers, own in zip(self.terms, start, strict=True):
            if powers.get(0) != own:
                return None
            total = Series.of(ring, [], p.most)
            for n, x in powers.items():
                if n <= p.most:
                    total += at_moved(Derivatives(ring, x), moves, p.most).shifted(n)
            result.append(total)
        return result[0], result[1]

    @cached_property
    def preserves_area(self) -> bool:
        """True where ΔJ is shown to be the zero function."""
        if self.conditions or self.implicit:
            return bool(self.conditions) and all(c.holds is True for c in self.conditions)
        ring, degree = self.ring, self.degree
        if degree is None:
            return ring.vanishes(self.delta_j) is True
        return all(ring.vanishes(self.coefficient(n)) is True for n in range(degree + 1))


def h_inside(ring: Ring, *elements: Poly) -> bool:
    """Whether h occurs inside a generator, so that x is not a polynomial in h."""
    return any(ring.depends(a, "h") for a in arguments(ring, *elements))
