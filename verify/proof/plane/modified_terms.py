"""The modified vector field of a map: f̃ = f₁ + h f₂ + h² f₃ + …, whose exact flow is the map.

Backward error analysis (Hairer, Lubich, Wanner, Geometric Numerical Integration, IX.1). With
F = h f̃ and D_F = F·∇, the time-h flow of f̃ is z' = Σ_n D_Fⁿ z/n!, as a series in h. Let
y_n = D_Fⁿ z/n!; it begins with hⁿ, and y_n = D_F y_(n−1)/n. For n ≥ 2 the coefficient [y_n]_k of hᵏ
in y_n contains only f_1 … f_(k−1), so that the map's coefficient d_k of hᵏ gives one term after the
other: f_k = d_k − Σ_(n=2)^k [y_n]_k.

The series need not converge; every coefficient is exact. If det J ≡ 1, every term has divergence 0.
For the flow φ of f̃ satisfies d/dt log det φ_t' = div f̃ along it: if div f_k is the first divergence
that is not 0, log det J = h · h^(k−1) div f_k + O(h^(k+1)), so that the leading
term of ΔJ = det J − 1 is h^k div f_k. ∎

If H depends on time, so does f̃, and the map from t to t + h is its flow with t' = 1. Then
D_F = F·∇ + h ∂/∂t, so that n [y_n]_k has the further term ∂/∂t [y_(n−1)]_(k−1).
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from verify.algebra.domain import FormulaDomain
from verify.algebra.embedding import embed
from verify.algebra.identities.polynomials import Poly
from verify.algebra.power_series import CoefficientRing
from verify.algebra.ring import Ring
from verify.hamiltonians.canonical_field import VectorField
from verify.proof.expansion import Leading
from verify.proof.plane.modified_equation import ModifiedEquation, Term

Vector = tuple[Poly, Poly]  # the components in p' and in q'


def modified_field(
    ring: CoefficientRing, p_next: Sequence[Poly], q_next: Sequence[Poly], timed: bool = False
) -> list[Vector]:
    """Return [f_1, f_2, …] for the map with these coefficients of h⁰, h¹, … in p' and q'.

    The coefficients of h⁰ are p and q; each later one gives a term. `timed`: True if they depend on
    t.
    """
    terms: list[Vector] = []
    # flows[n, k] is [y_n]_k, and gradients[n, k] its gradient.
    flows: dict[tuple[int, int], Vector] = {}
    gradients: dict[tuple[int, int], tuple[Vector, Vector]] = {}

    def along(vector: Vector, n: int, k: int) -> Vector:
        """Return the derivative of [y_n]_k along a vector field."""
        if (n, k) not in gradients:
            p, q = ((ring.diff(x, "p"), ring.diff(x, "q")) for x in flows[n, k])
            gradients[n, k] = p, q
        first, second = (vector[0] * by_p + vector[1] * by_q for by_p, by_q in gradients[n, k])
        return first, second

    for k in range(1, len(p_next)):
        term = p_next[k], q_next[k]
        # [y_n]_k = (1/n) Σ_j f_j·∇[y_(n−1)]_(k−j) contains only f_1 … f_(k−1), which are computed.
        for n in range(2, k + 1):
            total = ring.zero, ring.zero
            for j in range(1, k - n + 2):
                change = along(terms[j - 1], n - 1, k - j)
                total = total[0] + change[0], total[1] + change[1]
            if timed:
                later = [ring.diff(x, "t") for x in flows[n - 1, k - 1]]
                total = total[0] + later[0], total[1] + later[1]
            flows[n, k] = ring.reduce(total[0] / n), ring.reduce(total[1] / n)
            term = term[0] - flows[n, k][0], term[1] - flows[n, k][1]
        flows[1, k] = ring.reduce(term[0]), ring.reduce(term[1])
        terms.append(flows[1, k])
    return terms


def divergence(ring: CoefficientRing, vector: Vector) -> Poly:
    """Return the divergence of (p', q') = vector: ∂p'/∂p + ∂q'/∂q."""
    return ring.reduce(ring.diff(vector[0], "p") + ring.diff(vector[1], "q"))


def field_of(ring: CoefficientRing, energy: Poly) -> Vector:
    """Return the Hamiltonian vector field of G, (−∂G/∂q, ∂G/∂p)."""
    return -ring.diff(energy, "q"), ring.diff(energy, "p")


# -- the equation and its terms -------------------------------------------------------------------


class TermEnergy(NamedTuple):
    """The energy G of a Hamiltonian term: its formula and, for one H, its ring and element."""

    formula: str
    element: tuple[Ring, Poly] | None


def build_equation(
    flow: VectorField,
    after: tuple[Sequence[Poly], Sequence[Poly]],
    leading: Leading,
    energy_of: Callable[[Vector, int], TermEnergy | None],
    *,
    scheme: str,
    hamiltonian: str,
    domain: FormulaDomain,
) -> ModifiedEquation:
    """Build the modified equation from the coefficients of p' and q', `after`.

    `leading`: the leading coefficient of ΔJ. `energy_of(field, factors)`: finds G for a field with
    divergence 0 whose products have `factors` derivatives of H. `domain`: the domain of the map.
    """
    vectors = modified_field(flow.ring, *after, flow.timed)
    terms = [_term(flow.ring, j, vector, domain, energy_of) for j, vector in enumerate(vectors)]
    return ModifiedEquation(
        scheme=scheme,
        hamiltonian=hamiltonian,
        order=len(terms) - 1,
        terms=tuple(terms),
        consistent=_same(flow.ring, vectors[0], flow.slopes),
        area=_area(leading, terms),
        where=domain,
    )


def _term(
    ring: Any,
    power: int,
    vector: Vector,
    domain: FormulaDomain,
    energy_of: Callable[[Vector, int], TermEnergy | None],
) -> Term:
    """Build the term of h^power in the field: decide its divergence and look for its energy."""
    zero_field = ring.zero, ring.zero
    # A field that is zero by identities is replaced by 0, which its texts then show.
    vanishes = _same(ring, vector, zero_field)
    vector = zero_field if vanishes else vector
    div = divergence(ring, vector)
    decision = ring.decide(div)
    energy = (decision.zero and energy_of(vector, power + 1)) or None
    element = None if decision.zero else (ring, div)
    leading = Leading(None if decision.zero else power, decision, element).restrict_to(domain)
    return Term(
        power=power,
        p=ring.text(vector[0]),
        q=ring.text(vector[1]),
        hamiltonian=energy.formula if energy else None,
        vanishes=vanishes,
        is_hamiltonian=leading.decision.zero,
        divergence=leading.text,
        witness=leading.decision.witness,
        enclosure=leading.decision.enclosure,
        domain=leading.domain,
        energy=energy.element if energy else None,
        divergence_element=(ring, div),
    )


def _same(ring: CoefficientRing, vector: Vector, field: Sequence[Poly]) -> bool | None:
    """Return True if two fields are the same; None if that is not decided."""
    answers = {ring.vanishes(x - y) for x, y in zip(vector, field, strict=True)}
    return False if False in answers else None if None in answers else True


def _area(leading: Leading, terms: Sequence[Term]) -> bool | None:
    """Return True if the first divergence is the leading coefficient of ΔJ; None if undecided.

    If all terms are Hamiltonian: True if ΔJ vanishes as far as the terms reach.
    """
    first = next((x for x in terms if x.is_hamiltonian is not True), None)
    if leading.decision.zero is None or (first is not None and first.is_hamiltonian is None):
        return None
    if first is None:
        return leading.decision.zero or leading.power is None or leading.power > len(terms)
    if (
        leading.power != first.power + 1
        or leading.element is None
        or first.divergence_element is None
    ):
        return False
    # The leading term of ΔJ is h^k div f_k for the first divergence that is not 0: see the
    # module's text.
    (ring, x), (leading_ring, y) = first.divergence_element, leading.element
    if ring is leading_ring:
        return ring.vanishes(x - y)
    residual = ring.expression(x) - leading_ring.expression(y)
    common, (difference,) = embed([residual], ring.variables)
    return common.vanishes(difference)
