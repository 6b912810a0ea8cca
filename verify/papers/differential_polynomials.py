"""Differential polynomials over the rationals, for identities that hold for every H.

The partial derivatives of a generic H are independent variables H_ij = ∂^(i+j)H/∂pⁱ∂qʲ, with
∂H_ij/∂p = H_(i+1)j and ∂H_ij/∂q = H_i(j+1). An identity that holds for them as polynomials holds
for every smooth H. Other families, such as H = F(u) for a generic F of a fixed u, have variables
for the derivatives of F.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import flint

from verify.algebra.formula import parse, symbol
from verify.algebra.identities.polynomials import terms_of

Poly = flint.fmpq_mpoly


class Differential:
    """The ring over `names`; `set_gradient` gives a variable's partial derivatives by name.

    A variable without a gradient is a constant. `relate` adds relations, whose leading terms (in
    the lexicographic order of `names`) must be coprime: then dividing by each once is a normal
    form.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self.names = tuple(names)
        self.context = flint.fmpq_mpoly_ctx.get(list(names), flint.Ordering.lex)
        self._gens = dict(zip(names, self.context.gens(), strict=True))
        self._gradients: dict[str, Mapping[str, Poly]] = {}
        self._relations: list[Poly] = []

    def __getitem__(self, name: str) -> Poly:
        return self._gens[name]

    @property
    def zero(self) -> Poly:
        """The polynomial 0."""
        return self.context.constant(0)

    def set_gradient(self, name: str, **partials: Poly) -> None:
        """Set the partial derivatives of the variable `name`: ∂name/∂key for each key."""
        self._gradients[name] = partials

    def set_coordinates(self, first: str = "p", second: str = "q") -> None:
        """Declare the two independent variables of the partial derivatives."""
        one = self.context.constant(1)
        self.set_gradient(first, **{first: one, second: self.zero})
        self.set_gradient(second, **{first: self.zero, second: one})

    def relate(self, *relations: Poly) -> None:
        """Add the relations that each of these polynomials is 0."""
        self._relations += relations

    def reduce(self, x: Poly) -> Poly:
        """Return the normal form of x modulo the relations."""
        # Dividing by each relation once suffices, as their leading terms are coprime.
        for relation in self._relations:
            x = divmod(x, relation)[1]
        return x

    def diff(self, x: Poly, by: str) -> Poly:
        """Return ∂x/∂by in normal form. KeyError if a variable of x has no such derivative."""
        total, degrees = self.zero, x.degrees()
        for index, name in enumerate(self.names):
            # A variable without a gradient is a constant, and contributes nothing.
            if degrees[index] > 0 and name in self._gradients:
                total += x.derivative(index) * self._gradients[name][by]
        return self.reduce(total)

    def bracket(self, x: Poly, y: Poly) -> Poly:
        """Return the Jacobian determinant ∂(x, y)/∂(p, q)."""
        diff = self.diff
        return self.reduce(diff(x, "p") * diff(y, "q") - diff(x, "q") * diff(y, "p"))

    def powers(self, x: Poly, name: str) -> dict[int, Poly]:
        """Expand x in powers of a constant: {power: coefficient}, the coefficients non-zero."""
        index = self.names.index(name)
        parts: dict[int, Poly] = {}
        for monomial, coefficient in terms_of(x):
            # The exponent of the constant is removed from the monomial, and becomes the key.
            other_exponents = (*monomial[:index], 0, *monomial[index + 1 :])
            term = self.context.from_dict({other_exponents: coefficient})
            power = int(monomial[index])
            parts[power] = parts[power] + term if power in parts else term
        return parts


def free_variables(names: str) -> list[Poly]:
    """Return independent variables with these names, separated by blanks."""
    ring = Differential(names.split())
    return [ring[name] for name in ring.names]


@dataclass(frozen=True)
class DifferentialFlow:
    """The field X = H_p ∂_q − H_q ∂_p over such a ring: p' = −H_q, q' = H_p (Eq. 1)."""

    ring: Differential
    h_p: Poly
    h_q: Poly

    def derive(self, y: Poly) -> Poly:
        """Return X y."""
        diff = self.ring.diff
        return self.ring.reduce(self.h_p * diff(y, "q") - self.h_q * diff(y, "p"))

    def lie_derivatives(self, name: str, highest: int) -> list[Poly]:
        """Return [y, X y, …, X^highest y] of y = p or q."""
        result = [self.ring[name]]
        for _ in range(highest):
            result.append(self.derive(result[-1]))
        return result

    @property
    def hessian(self) -> tuple[Poly, Poly, Poly]:
        """The entries H_pp, H_pq, H_qq."""
        diff = self.ring.diff
        return diff(self.h_p, "p"), diff(self.h_p, "q"), diff(self.h_q, "q")

    @property
    def hessian_determinant(self) -> Poly:
        """The determinant H_pp H_qq − H_pq²."""
        pp, pq, qq = self.hessian
        return self.ring.reduce(pp * qq - pq * pq)

    def delta_j(self, p_next: Poly, q_next: Poly) -> dict[int, Poly]:
        """Return ΔJ of the map (p, q) → (p_next, q_next), by powers of h."""
        return self.ring.powers(self.ring.bracket(p_next, q_next) - 1, "h")

    def delta_j_gaps(self, eta: int, **expected: Poly) -> list[Poly]:
        """Return the coefficients of h, h², … in ΔJ of lieη minus the `expected` ones (h3=…)."""
        computed = self.delta_j(*self.lie(eta))
        # Powers beyond the expected ones must vanish too, so that the range covers both.
        powers = range(1, max([*computed, 2 * eta]) + 1)
        zero = self.ring.zero
        return [computed.get(n, zero) - expected.get(f"h{n}", zero) for n in powers]

    def lie(self, eta: int) -> tuple[Poly, Poly]:
        """Return p', q' of the scheme lieη (Eq. 2)."""
        h = self.ring["h"]
        images = []
        for name in ("p", "q"):
            total, factor = self.ring.zero, self.ring.context.constant(1)
            for n, term in enumerate(self.lie_derivatives(name, eta)):
                # hⁿ/n!, built up factor by factor.
                factor = factor * h / n if n else factor
                total += factor * term
            images.append(total)
        return images[0], images[1]


def flow_of_every_hamiltonian(order: int, extra_names: Sequence[str] = ()) -> DifferentialFlow:
    """Return the flow of a generic H, whose partial derivatives up to `order` are variables."""
    pairs = [(i, n - i) for n in range(1, order + 1) for i in range(n, -1, -1)]
    ring = Differential(["h", *extra_names, "p", "q", *(f"H{i}_{j}" for i, j in pairs)])
    ring.set_coordinates()
    for i, j in pairs:
        if i + j < order:
            ring.set_gradient(f"H{i}_{j}", p=ring[f"H{i + 1}_{j}"], q=ring[f"H{i}_{j + 1}"])
        else:
            ring.set_gradient(f"H{i}_{j}")  # its derivatives are beyond the order
    return DifferentialFlow(ring, ring["H1_0"], ring["H0_1"])


def flow_of_one_function(
    constants: Sequence[str], u: str, rest: str, order: int = 4
) -> DifferentialFlow:
    """Return the flow of H = F(u) + rest for a generic F, with polynomials u and rest.

    u and rest may contain p, q and the constants. The derivatives of F at u up to `order` are the
    variables F1, F2, …
    """
    ring = Differential(["h", *constants, "p", "q", *(f"F{k}" for k in range(1, order + 1))])
    ring.set_coordinates()
    inner, outer = (_polynomial(ring, text) for text in (u, rest))
    u_p, u_q = ring.diff(inner, "p"), ring.diff(inner, "q")
    # The chain rule: ∂F_k/∂p = F_(k+1) ∂u/∂p.
    for k in range(1, order):
        ring.set_gradient(f"F{k}", p=ring[f"F{k + 1}"] * u_p, q=ring[f"F{k + 1}"] * u_q)
    ring.set_gradient(f"F{order}")
    f1 = ring["F1"]
    return DifferentialFlow(
        ring, f1 * u_p + ring.diff(outer, "p"), f1 * u_q + ring.diff(outer, "q")
    )


def _polynomial(ring: Differential, text: str) -> Poly:
    expression = parse(text, ring.names, source="u").as_poly(*map(symbol, ring.names))
    terms = {m: flint.fmpq(int(c.p), int(c.q)) for m, c in expression.terms()}
    return ring.context.from_dict(terms)
