"""Check a certificate with the standard library alone, and no code of the prover.

**Theorem**, which acceptance proves. Let X f = H_p f_q − H_q f_p for a function H of p and q; with
`degrees` this is summed over p_i and q_i. With `time_dependent` H depends on t, too: then in all
that follows X stands for D = ∂_t + X, "the flow" is that from t to t + h, and J and each identity
are taken at one t, which is arbitrary.

*For one H*, a polynomial in p, q, parameters and functions. At all points where no denominator is
0, as at the witness, and for every map p' = Σ p_n hⁿ + O(h^(m+1)), q' likewise, with the `p_next`
and `q_next` of the certificate and a smooth remainder, m the larger of `order` r and
`convergence_order` c:

1. p_n = Xⁿp/n! and q_n = Xⁿq/n! for n ≤ c: the map agrees with the flow of H up to h^c;
2. det J − 1 = L h^r + O(h^(r+1)) with L = `leading`, which is not 0 at the witness, and so, being
   analytic, not the zero function on any open set;
3. X·G = L for the `potential` G, if there is one.

With `order` null, for the map p' = Σ p_n hⁿ, q' = Σ q_n hⁿ without a remainder: 1., and det J = 1.

With `degrees`, S = JᵀΩJ − Ω takes the place of det J − 1, and 2-forms that of L and G:
2. S = L h^r + O(h^(r+1)), and an entry of L is not 0 at the witness; 3. the Lie derivative of G is
L. With `order` null: S = 0, and the map is symplectic.

*For every H* (`separable`: every H = T(p) + V(q)), the same for each smooth H at every point; L, or
an entry of the 2-form L, is a polynomial in p, q and the derivatives of H that is not 0, and so is
not 0 for some H.

*For stages*, for every H: det J = 1 for each smooth map (p, q) ↦ (p', q') that solves
p' = p − h k H_q, q' = q + h d H_p at (p + s (p' − p), q + u (q' − q)), wherever the derivatives of
these equations by (p', q') have a determinant det A ≠ 0; and so for one stage after the other. With
`time_dependent` a stage has one time, t + c h with c any, at which both H_q and H_p are taken. With
`degrees`, S = 0 in n degrees of freedom.

*For a tableau* (a_ij; b_i), for every H: S = 0, and in the plane det J = 1, of each map
(p, q) ↦ (p', q') with p' = p − h Σ b_i H_q and q' = q + h Σ b_i H_p, these taken at (P_i, Q_i), and
with `time_dependent` at t + c_i h, wherever P_i, Q_i depend smoothly on (p, q) and solve
P_i = p − h Σ a_ij H_q, Q_i = q + h Σ a_ij H_p, taken at (P_j, Q_j) and t + c_j h.

Coefficients of stages and of a tableau may be polynomials in `numbers`: each name stands for the
one real number that is a root of its polynomial in its interval.

**Proof.** Names are differentiated by the rules for the functions they stand for, which satisfy the
relations (sin² + cos² = 1, u · 1/u = 1): so an identity of polynomials up to Σ cofactor · relation
is an identity of functions. For every H its derivatives are free: an identity of polynomials in
them holds for each H, and at a point they take any values. With t as a coordinate, t' = 1, the flow
is that of D. The entry ab of S is Σ_i (p_i',a q_i',b − p_i',b q_i',a) less that of Ω. In the plane
its one entry is det J − 1, and the Lie derivative of G dp∧dq is (X·G) dp∧dq, as X preserves dp∧dq.
For stages and tableaux see `verify.proof.certificates.coefficients`: at the time of a stage H is a
function of p and q. `verify.proof.certificates.named_numbers` shows that each name stands for
exactly one number; a sum of multiples of the numbers' polynomials has the value 0.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import combinations
from math import factorial

from verify.proof.certificates.balls import Ball, function, plus, times
from verify.proof.certificates.coefficients import ONE, ButcherTableau, Stages, check_coefficients
from verify.proof.certificates.entries import Expansion, derived_by, read
from verify.proof.certificates.readers import Monomial, Poly, bits_of, collect_terms, need

Term = tuple[Monomial, Fraction]
_MOST_WORK = 1_000_000  # limit in terms, long ones counting more; it takes some seconds


def check(data: object) -> Stages | ButcherTableau | Expansion:
    """Check a certificate and return its entries; ValueError names the identity that fails."""
    entries = read(data)
    if isinstance(entries, Expansion):
        Identities(entries).check()
    else:
        check_coefficients(entries)
    return entries


def single(name: str) -> Poly:
    """Return the polynomial that is just this name."""
    return {(name,): Fraction(1)}


class Identities:
    """The identities that the theorem asserts, checked one by one.

    A name is differentiated by the coordinates and t: a derivative of H gives one more derivative
    of H, and a function follows the chain rule.
    """

    def __init__(self, entries: Expansion) -> None:
        self.entries, self.cofactors = entries, dict(entries.cofactors)
        self.values: dict[str, Ball] = {n: (x, Fraction(0)) for n, x in entries.witness.items()}
        self.work = 0
        self.variables = (*entries.coordinates, *("t",) * entries.timed)
        n = len(entries.coordinates) // 2
        pairs = zip(entries.coordinates[:n], entries.coordinates[n:], strict=True)
        self.pairs = list(pairs)
        self.images: dict[str, dict[str, Poly]] = {by: {by: ONE} for by in self.variables}
        self.relations: dict[str, Poly] = {}
        for entry in entries.functions:
            slope = self.slope(entry.name, entry.kind, entry.argument)
            self.images[entry.name] = {
                by: self.mul(slope, self.diff(entry.argument, by)) for by in self.variables
            }
        # The derivatives of H by each coordinate; for every H they are names.
        self.slopes: dict[str, Poly] = {}
        for by in entries.coordinates:
            h = entries.hamiltonian
            self.slopes[by] = single(f"H_{by}") if h is None else self.diff(h, by)

    def slope(self, name: str, kind: str, u: Poly) -> Poly:
        """Return the derivative of the function by its argument, and record its relation."""
        itself = single(name)
        if kind == "exp":
            return itself
        if kind == "inverse":
            self.relations[name] = self.add(self.mul(itself, u), ONE, -1)
            return self.mul(itself, itself, -1)
        partner = {"sin": "cos", "cos": "sin"}[kind]
        partners = [f.name for f in self.entries.functions if (f.kind, f.argument) == (partner, u)]
        need(partners, f"{name}: there is no {partner} of its argument")
        side = single(partners[0])
        squares = self.add(self.mul(itself, itself), self.mul(side, side))
        self.relations[name] = self.add(squares, ONE, -1)
        return self.add({}, side, 1 if kind == "sin" else -1)

    def image(self, name: str, by: str) -> Poly:
        if name in self.images or not name.startswith("H_"):
            return self.images.get(name, {}).get(by, {})  # a parameter has the derivative 0
        derived = sorted([*derived_by(name), by], key=self.variables.index)
        mixed = len({x[0] for x in derived} & {"p", "q"}) == 2
        return {} if self.entries.separable and mixed else single("H_" + "".join(derived))

    def add(self, x: Poly, y: Poly, scale: Fraction | int = 1) -> Poly:
        return self.sum_of([*x.items(), *((m, scale * c) for m, c in y.items())])

    def mul(self, x: Poly, y: Poly, scale: int = 1) -> Poly:
        return self.sum_of((m + n, scale * c * d) for m, c in x.items() for n, d in y.items())

    def diff(self, x: Poly, by: str) -> Poly:
        return self.sum_of(
            (names[:k] + names[k + 1 :] + m, c * d)
            for names, c in x.items()
            for k, name in enumerate(names)
            for m, d in self.image(name, by).items()
        )

    def along_flow(self, x: Poly) -> Poly:
        """Return X x, or D x where H depends on time."""
        slope: Poly = {}
        for p, q in self.pairs:
            slope = self.add(slope, self.mul(self.slopes[p], self.diff(x, q)))
            slope = self.add(slope, self.mul(self.slopes[q], self.diff(x, p)), -1)
        return self.add(slope, self.diff(x, "t")) if self.entries.timed else slope

    def sum_of(self, terms: Iterable[Term]) -> Poly:
        return collect_terms(map(self.count_work, terms))

    def count_work(self, term: Term) -> Term:
        names, c = term
        # Work is counted roughly in words of 64 bits, so that no certificate can stall the checker.
        self.work += 1 + (8 * len(names) + bits_of(c)) // 64
        need(self.work <= _MOST_WORK, "is too large to be checked here")
        return term

    # -- the identities -------------------------------------------------------------------------

    def check(self) -> None:
        """Check all identities; ValueError names the first one that does not hold."""
        entries = self.entries
        problem = "order, leading: one says that det J is 1, and one that it is not"
        need((entries.order is None) == (not entries.leading), problem)
        fits = entries.last is None or entries.length <= entries.last + 1
        need(fits, f"{entries.layout.maps}: are longer than is said of them")
        for identity, residual in self.residuals():
            for name, cofactor in self.cofactors.pop(identity, {}).items():
                need(name in self.relations, f"cofactors of {identity}: {name!a} has no relation")
                residual = self.add(residual, self.mul(cofactor, self.relations[name]), -1)
            need(not residual, f"{identity} is not zero")
        # Cofactors of an unknown identity may be a misspelled name, and are refused.
        unused = min(self.cofactors, default="")
        need(not self.cofactors, f"cofactors: nothing asks for {unused!a}")
        self.check_witness()

    def residuals(self) -> Iterator[tuple[str, Poly]]:
        """Yield each polynomial that must be 0, with its name."""
        yield from self.residuals_of_flow()
        yield from self.residuals_of_defect(self.entries.order or 2 * self.entries.length)
        yield from self.residuals_of_potential()

    def residuals_of_flow(self) -> Iterator[tuple[str, Poly]]:
        for coordinate, series in zip(self.entries.coordinates, self.entries.after, strict=True):
            flow = single(coordinate)
            for n in range(self.entries.convergence_order + 1):
                if n:
                    flow = self.along_flow(flow)
                coefficient = series[n] if n < len(series) else {}
                yield f"{coordinate} {n}", self.add(coefficient, flow, Fraction(-1, factorial(n)))

    def residuals_of_defect(self, last: int) -> Iterator[tuple[str, Poly]]:
        """Yield the residuals of S at h¹ … h^last; at h⁰ the map is the identity."""
        entries = self.entries
        after = dict(zip(entries.coordinates, entries.after, strict=True))
        slopes = {
            (coordinate, by): [self.diff(c, by) for c in series[: last + 1]]
            for coordinate, series in after.items()
            for by in entries.coordinates
        }
        for n in range(1, last + 1):
            for a, b in combinations(entries.coordinates, 2):
                expected = entries.leading.get((a, b), {}) if n == entries.order else {}
                residual = self.add({}, expected, -1)
                for p, q in self.pairs:
                    products = (slopes[p, a], slopes[q, b]), (slopes[p, b], slopes[q, a])
                    for (x, y), sign in zip(products, (1, -1), strict=True):
                        # The coefficient of hⁿ in the product of two series of finite lengths.
                        for k in range(max(0, n - len(y) + 1), min(n + 1, len(x))):
                            residual = self.add(residual, self.mul(x[k], y[n - k]), sign)
                yield entries.layout.defect.format(n, a, b), residual

    def residuals_of_potential(self) -> Iterator[tuple[str, Poly]]:
        """Yield X G_ab + Σ_c (f_c,a G_cb + G_ac f_c,b) − L_ab, f = (−H_q, H_p), each to be 0."""
        entries, potential = self.entries, self.entries.potential
        if potential is None:
            return

        def entry(a: str, b: str) -> Poly:
            turned = (a, b) not in potential and (b, a) in potential
            return self.add({}, potential[b, a], -1) if turned else potential.get((a, b), {})

        field = {p: self.add({}, self.slopes[q], -1) for p, q in self.pairs}
        field |= {q: self.slopes[p] for p, q in self.pairs}
        for a, b in combinations(entries.coordinates, 2):
            residual = self.add(self.along_flow(entry(a, b)), entries.leading.get((a, b), {}), -1)
            # The divergence f_a,a + f_b,b is 0 if a, b are a pair p_i, q_i, as in the plane.
            divergence = self.add(self.diff(field[a], a), self.diff(field[b], b))
            residual = self.add(residual, self.mul(divergence, entry(a, b)))
            for c in (x for x in entries.coordinates if x not in (a, b)):
                residual = self.add(residual, self.mul(self.diff(field[c], a), entry(c, b)))
                residual = self.add(residual, self.mul(entry(a, c), self.diff(field[c], b)))
            yield entries.layout.potential.format(a, b), residual

    def check_witness(self) -> None:
        """Check that at the witness no denominator is 0, and L, or an entry of it, is not 0."""
        inverses = [f.name for f in self.entries.functions if f.kind == "inverse"]
        if self.entries.hamiltonian is None or not (inverses or self.entries.leading):
            need(not self.entries.witness, "witness: there is nothing to see")
            return
        need(self.entries.witness, "witness: is missing")
        for name in inverses:
            self.value_of(name)
        if self.entries.leading:
            balls = (self.value(x) for x in self.entries.leading.values())
            is_nonzero = any(abs(midpoint) > radius for midpoint, radius in balls)
            need(is_nonzero, "the leading coefficient may be 0 at the witness")

    def value(self, x: Poly) -> Ball:
        """Enclose the polynomial at the witness."""
        total = Fraction(0), Fraction(0)
        for names, c in x.items():
            term = c, Fraction(0)
            for name in names:
                term = times(term, self.value_of(name))
            total = plus(total, term)
        return total

    def value_of(self, name: str) -> Ball:
        if name not in self.values:
            function_entry = next(f for f in self.entries.functions if f.name == name)
            self.values[name] = function(function_entry.kind, self.value(function_entry.argument))
        return self.values[name]
