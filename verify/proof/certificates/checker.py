"""Checks a certificate with the standard library alone; it shares nothing with the prover.

**Theorem** (what acceptance proves). Let X f = H_p f_q − H_q f_p for a function H of p and q; with
`degrees` that is summed over p_i and q_i. With `time_dependent` H is one of t, too, and in all that
follows X stands for D = ∂_t + X, "flow" for that from t to t + h, and J and each identity are taken
at one t, which is any.

*Of one H*, a polynomial in p, q, parameters and functions. Where no denominator among them is 0,
which is so at the witness: for every map p' = Σ p_n hⁿ + O(h^(m+1)), q' likewise, with the `p_next`
and `q_next` of the certificate and a smooth remainder, m the larger of `order` r and
`convergence_order` c,

1. p_n = Xⁿp/n! and q_n = Xⁿq/n! for n ≤ c: the map agrees with the flow of H up to h^c;
2. det J − 1 = L h^r + O(h^(r+1)) with L = `leading`, which is not 0 at the witness, and so, being
   analytic, not the zero function on any open set;
3. X·G = L for the `potential` G, where there is one.

With `order` null, for the map p' = Σ p_n hⁿ, q' = Σ q_n hⁿ without a remainder: 1, and det J = 1.

With `degrees`, the same with S = JᵀΩJ − Ω in place of det J − 1 and 2-forms in place of L and G:
2. S = L h^r + O(h^(r+1)), an entry of L being other than 0 at the witness; 3. the Lie derivative of
G is L. With `order` null: S = 0, and the map is symplectic.

*Of every H* (`separable`: every H = T(p) + V(q)), the same for each smooth H at every point; L is
a polynomial in p, q and the derivatives of H that is not 0, and so is not 0 for some H. (Of a
2-form, one of its entries is.)

*Of stages*, for every H: det J = 1 for each smooth map (p, q) ↦ (p', q') that solves
p' = p − h k H_q, q' = q + h d H_p at (p + s (p' − p), q + u (q' − q)), wherever the derivatives of
these equations by (p', q') have a determinant det A ≠ 0; and so for one stage after the other. With
`time_dependent` a stage has one time, t + c h with c any, at which both H_q and H_p are taken. With
`degrees`, S = 0 in so many degrees of freedom.

*Of a tableau* (a_ij; b_i), for every H: S = 0, and in the plane det J = 1, of each map
(p, q) ↦ (p', q') with p' = p − h Σ b_i H_q and q' = q + h Σ b_i H_p, these taken at (P_i, Q_i), and
with `time_dependent` at t + c_i h, wherever P_i, Q_i depend smoothly on (p, q) and solve
P_i = p − h Σ a_ij H_q, Q_i = q + h Σ a_ij H_p, taken at (P_j, Q_j) and t + c_j h.

Coefficients of stages and of a tableau may be polynomials in `numbers`: each name stands for the
one real number that is a root of its polynomial in its interval.

**Proof.** Names are differentiated by the rules for what they stand for, and the relations are true
of that (sin² + cos² = 1, u · 1/u = 1): an identity up to Σ cofactor · relation is one of functions.
For every H its derivatives are free: an identity of polynomials in them holds for each H, and at a
point they take any values. With t as a coordinate, t' = 1, the flow is that of D. The entry ab of S
is Σ_i (p_i',a q_i',b − p_i',b q_i',a) less that of Ω; in the plane its one entry is det J − 1, and
the Lie derivative of G dp∧dq is (X·G) dp∧dq, as X preserves dp∧dq. For stages and tableaux see
`verify.proof.certificates.coefficients`: at its own time the H of each stage is a function of p and
q. That each number is one, and one alone, `verify.proof.certificates.numbers` shows; a polynomial
in them that is a sum of multiples of their own polynomials has the value 0.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import combinations
from math import factorial

from verify.proof.certificates.balls import Ball, function, plus, times
from verify.proof.certificates.coefficients import ONE, Stages, Tableau, check_coefficients
from verify.proof.certificates.entries import Expansion, derived_by, read
from verify.proof.certificates.readers import Monomial, Poly, bits_of, collected, need

Term = tuple[Monomial, Fraction]
_MOST_WORK = 1_000_000  # terms that are made, more for long ones: some seconds


def check(data: object) -> Stages | Tableau | Expansion:
    """The certificate's entries, of which the theorem holds; ValueError names what fails."""
    entries = read(data)
    if isinstance(entries, Expansion):
        Identities(entries).check()
    else:
        check_coefficients(entries)
    return entries


def single(name: str) -> Poly:
    """The polynomial that is one name."""
    return {(name,): Fraction(1)}


class Identities:
    """What the theorem says, identity by identity.

    The derivatives of every name by the coordinates and t are the free derivatives of H, or those
    of functions of arguments.
    """

    def __init__(self, entries: Expansion) -> None:
        self.given, self.cofactors = entries, dict(entries.cofactors)
        self.values: dict[str, Ball] = {n: (x, Fraction(0)) for n, x in entries.witness.items()}
        self.work = 0
        self.variables = (*entries.coordinates, *("t",) * entries.timed)
        n = len(entries.coordinates) // 2
        pairs = zip(entries.coordinates[:n], entries.coordinates[n:], strict=True)
        self.pairs = list(pairs)
        self.images: dict[str, dict[str, Poly]] = {by: {by: ONE} for by in self.variables}
        self.relations: dict[str, Poly] = {}
        for made in entries.functions:
            slope = self.slope(made.name, made.kind, made.argument)
            self.images[made.name] = {
                by: self.mul(slope, self.diff(made.argument, by)) for by in self.variables
            }
        self.slopes: dict[str, Poly] = {}  # of H, by each coordinate
        for by in entries.coordinates:
            h = entries.hamiltonian
            self.slopes[by] = single(f"H_{by}") if h is None else self.diff(h, by)

    def slope(self, name: str, kind: str, u: Poly) -> Poly:
        """The derivative of the function by its argument; a relation that it obeys is noted."""
        own = single(name)
        if kind == "exp":
            return own
        if kind == "inverse":
            self.relations[name] = self.add(self.mul(own, u), ONE, -1)
            return self.mul(own, own, -1)
        partner = {"sin": "cos", "cos": "sin"}[kind]
        same = [f.name for f in self.given.functions if (f.kind, f.argument) == (partner, u)]
        need(same, f"{name}: there is no {partner} of its argument")
        side = single(same[0])
        squares = self.add(self.mul(own, own), self.mul(side, side))
        self.relations[name] = self.add(squares, ONE, -1)
        return self.add({}, side, 1 if kind == "sin" else -1)

    def image(self, name: str, by: str) -> Poly:
        if name in self.images or not name.startswith("H_"):
            return self.images.get(name, {}).get(by, {})  # a parameter has none
        derived = sorted([*derived_by(name), by], key=self.variables.index)
        mixed = len({x[0] for x in derived} & {"p", "q"}) == 2
        return {} if self.given.separable and mixed else single("H_" + "".join(derived))

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
        """X x, or D x."""
        slope: Poly = {}
        for p, q in self.pairs:
            slope = self.add(slope, self.mul(self.slopes[p], self.diff(x, q)))
            slope = self.add(slope, self.mul(self.slopes[q], self.diff(x, p)), -1)
        return self.add(slope, self.diff(x, "t")) if self.given.timed else slope

    def sum_of(self, terms: Iterable[Term]) -> Poly:
        return collected(map(self.counted, terms))

    def counted(self, term: Term) -> Term:
        names, c = term
        self.work += 1 + (8 * len(names) + bits_of(c)) // 64
        need(self.work <= _MOST_WORK, "is too large to be checked here")
        return term

    # -- what has to hold -----------------------------------------------------------------------

    def check(self) -> None:
        """ValueError names the first of them that does not hold."""
        given = self.given
        said = "order, leading: one says that det J is 1, and one that it is not"
        need((given.order is None) == (not given.leading), said)
        fits = given.last is None or given.length <= given.last + 1
        need(fits, f"{given.layout.maps}: are longer than is said of them")
        for what, gap in self.gaps():
            for name, cofactor in self.cofactors.pop(what, {}).items():
                need(name in self.relations, f"cofactors of {what}: {name!a} has no relation")
                gap = self.add(gap, self.mul(cofactor, self.relations[name]), -1)
            need(not gap, f"{what} is not zero")
        unused = min(self.cofactors, default="")
        need(not self.cofactors, f"cofactors: nothing asks for {unused!a}")
        self.check_witness()

    def gaps(self) -> Iterator[tuple[str, Poly]]:
        """All that has to be 0, each by its name."""
        yield from self.gaps_of_flow()
        yield from self.gaps_of_defect(self.given.order or 2 * self.given.length)
        yield from self.gaps_of_potential()

    def gaps_of_flow(self) -> Iterator[tuple[str, Poly]]:
        for by, series in zip(self.given.coordinates, self.given.after, strict=True):
            flow = single(by)
            for n in range(self.given.convergence_order + 1):
                if n:
                    flow = self.along_flow(flow)
                own = series[n] if n < len(series) else {}
                yield f"{by} {n}", self.add(own, flow, Fraction(-1, factorial(n)))

    def gaps_of_defect(self, last: int) -> Iterator[tuple[str, Poly]]:
        """Up to h^last; that of h⁰ is 0, as the map there is the identity."""
        given, after = self.given, dict(zip(self.given.coordinates, self.given.after, strict=True))
        slopes = {
            (of, by): [self.diff(c, by) for c in series[: last + 1]]
            for of, series in after.items()
            for by in given.coordinates
        }
        for n in range(1, last + 1):
            for a, b in combinations(given.coordinates, 2):
                expected = given.leading.get((a, b), {}) if n == given.order else {}
                gap = self.add({}, expected, -1)
                for p, q in self.pairs:
                    both = (slopes[p, a], slopes[q, b]), (slopes[p, b], slopes[q, a])
                    for (x, y), sign in zip(both, (1, -1), strict=True):
                        for k in range(max(0, n - len(y) + 1), min(n + 1, len(x))):
                            gap = self.add(gap, self.mul(x[k], y[n - k]), sign)
                yield given.layout.defect.format(n, a, b), gap

    def gaps_of_potential(self) -> Iterator[tuple[str, Poly]]:
        """That its Lie derivative is L: X G_ab + Σ_c (f_c,a G_cb + G_ac f_c,b), f = (−H_q, H_p)."""
        given, potential = self.given, self.given.potential
        if potential is None:
            return

        def at(a: str, b: str) -> Poly:
            turned = (a, b) not in potential and (b, a) in potential
            return self.add({}, potential[b, a], -1) if turned else potential.get((a, b), {})

        field = {p: self.add({}, self.slopes[q], -1) for p, q in self.pairs}
        field |= {q: self.slopes[p] for p, q in self.pairs}
        for a, b in combinations(given.coordinates, 2):
            gap = self.add(self.along_flow(at(a, b)), given.leading.get((a, b), {}), -1)
            # f_a,a + f_b,b is 0 of a pair, and so of all that there is in the plane.
            both = self.add(self.diff(field[a], a), self.diff(field[b], b))
            gap = self.add(gap, self.mul(both, at(a, b)))
            for c in (x for x in given.coordinates if x not in (a, b)):
                gap = self.add(gap, self.mul(self.diff(field[c], a), at(c, b)))
                gap = self.add(gap, self.mul(at(a, c), self.diff(field[c], b)))
            yield given.layout.potential.format(a, b), gap

    def check_witness(self) -> None:
        """That there is a point where all functions have a value, and L another than 0."""
        inverses = [f.name for f in self.given.functions if f.kind == "inverse"]
        if self.given.hamiltonian is None or not (inverses or self.given.leading):
            need(not self.given.witness, "witness: there is nothing to see")
            return
        need(self.given.witness, "witness: is missing")
        for name in inverses:
            self.value_of(name)
        if self.given.leading:
            balls = (self.value(x) for x in self.given.leading.values())
            seen = any(abs(middle) > radius for middle, radius in balls)
            need(seen, "the leading coefficient may be 0 at the witness")

    def value(self, x: Poly) -> Ball:
        """At the witness."""
        total = Fraction(0), Fraction(0)
        for names, c in x.items():
            term = c, Fraction(0)
            for name in names:
                term = times(term, self.value_of(name))
            total = plus(total, term)
        return total

    def value_of(self, name: str) -> Ball:
        if name not in self.values:
            made = next(f for f in self.given.functions if f.name == name)
            self.values[name] = function(made.kind, self.value(made.argument))
        return self.values[name]
