"""The modified vector field of a map: f̃ = f₁ + h f₂ + h² f₃ + …, whose exact flow is the map.

Backward error analysis (Hairer, Lubich, Wanner, Geometric Numerical Integration, IX.1). With
F = h f̃ and D_F = F·∇, the time-h flow of f̃ is z' = Σ_n D_Fⁿ z/n!, as a series in h. Let
y_n = D_Fⁿ z/n!; it begins with hⁿ, and y_n = D_F y_(n−1)/n. The coefficient of hᵏ in y_n for n ≥ 2
has only f_1 … f_(k−1) in it, so that the map's own coefficient d_k gives
f_k = d_k − Σ_(n=2)^k [y_n]_k, one after the other.

The series need not converge; every coefficient is exact. Of a map with det J ≡ 1 every term has
divergence 0. For the flow φ of f̃ satisfies d/dt log det φ_t' = div f̃ along it: where div f_k is the
first divergence that is not 0, log det J = h · h^(k−1) div f_k + O(h^(k+1)), so that the leading
term of ΔJ = det J − 1 is h^k div f_k. ∎

Where H depends on time so does f̃, and the map from t to t + h is its flow with t' = 1. Then it is
D_F = F·∇ + h ∂/∂t, by which y_n has ∂/∂t of [y_(n−1)]_(k−1) as well.
"""

from collections.abc import Sequence

from verify.algebra.generator import Poly
from verify.algebra.series.power_series import CoefficientRing

Vector = tuple[Poly, Poly]  # the parts of p' and of q'


def modified_field(
    ring: CoefficientRing, p_next: Sequence[Poly], q_next: Sequence[Poly], timed: bool = False
) -> list[Vector]:
    """Return [f_1, f_2, …] for the map with these coefficients of h⁰, h¹, … in p' and q'.

    The coefficients of h⁰ are p and q, and each further one gives a term. `timed`: they depend
    on t.
    """
    terms: list[Vector] = []
    # flows[n][k]: [y_n]_k, with its gradient, which is made once.
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
        # [y_n]_k = (1/n) Σ_j f_j·∇[y_(n−1)]_(k−j): only f_1 … f_(k−1), all of them computed before.
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
