"""The growth law of Λ: the bounded part of log(1 + Λ), the part that grows with T, the remainder.

Setting. Φ is one step of size h of a scheme of order η ≥ 1 for a smooth H, z_k = Φᵏ(z₀), T = N h,
log(1 + Λ) = Σ_{k<N} log(1 + ΔJ(z_k)), and log(1 + ΔJ) = h^r c_r + h^(r+1) c_(r+1) + … with r ≥ 2
(so that c_r and c_(r+1) are also coefficients of ΔJ, as ΔJ² is O(h^2r) and 2r ≥ r + 2). K is a
compact ring of closed orbits of the exact flow φ, with no equilibrium in it (for a rotation, on the
cylinder). For g on K, ⟨g⟩ is its time average along the orbit and B_g the solution of X B_g = g −
⟨g⟩; both are smooth on K, as g is a smooth periodic function of time on each orbit, whose period is
smooth and positive. [F] means F(z_N) − F(z₀), at the NUMERICAL end point: the phase of z_N differs
from the exact one by up to O(h^η T (1 + T)), so that [F] along the exact orbit means nothing for
long times. An error R of the predicted log(1 + Λ) is an error (1 + Λ)(e^R − 1) of Λ.

Theorem. There are h₀ and C, which depend on H, the scheme and K alone, so that for all h ≤ h₀ and
all N for which z₀ … z_N lie in K:

  even η, `lieη` (r = η + 1, and c_r = X G, see `telescoping`), with g = c_(r+1):
    log(1 + Λ) = h^η [G] + h^(η+1) (T ⟨g⟩(z₀) + [B_g − ½ X G]) + R,
    |R| ≤ C (h^(η+2) T + h^(η+1) Σ h |H(z_k) − H(z₀)|);

  any scheme, in particular `lieη` of odd η (r = η + 1, if that coefficient is not 0), with g = c_r:
    log(1 + Λ) = h^(r−1) (T ⟨g⟩(z₀) + [B_g]) + R,
    |R| ≤ C (h^r T + h^(r−1) Σ h |H(z_k) − H(z₀)|).

  |H(z_k) − H(z₀)| ≤ C h^η t_k, t_k = k h, and ≤ C (h^η + h^(η+1) t_k) for `lieη` of even η. So
    even η:  |R| ≤ C h^(η+2) T (1 + h^η T),    relative to h^(η+1) T ⟨g⟩ ≠ 0:  O(h) + O(h^(η+1) T);
    odd η:   |R| ≤ C h^(η+1) T (1 + h^(η−1) T), relative to h^η T ⟨g⟩ ≠ 0:  O(h) + O(h^η T).
  An orbit with a ring around it stays in the ring while h^(η+1) T (odd: h^η T) is below a constant,
  so there the bounds hold uniformly. In both laws the boundary part, in [ ], is bounded for all T.

Proof. For smooth F, Φ = φ_h + O(h^(η+1)) gives, uniformly on K,
  (1)  F(Φ z) − F(z) = h X F + ½ h² X² F + O(h³) + O(h^(η+1)).
Any scheme: c_r = ⟨c_r⟩ + X B, and by (1) h X B = B(Φ z) − B(z) + O(h²). Summed, h^r Σ X B(z_k) =
h^(r−1) [B] + O(N h^(r+1)), and the terms from h^(r+1) on are O(N h^(r+1)) = O(h^r T). ⟨c_r⟩ depends
smoothly on the orbit, that is on H: h^r Σ ⟨c_r⟩(z_k) = h^(r−1) T ⟨c_r⟩(z₀) up to what R has.
Even η: (1) for G reads h X G = G(Φ z) − G(z) − ½ h² X² G + O(h³), as η ≥ 2. Times h^η and summed,
h^(η+1) Σ X G(z_k) = h^η [G] − ½ h^(η+2) Σ X² G(z_k) + O(N h^(η+3)). Both X² G = X (X G) and the
oscillating part of g are derivatives along the flow: (1) sums them to −½ h^(η+1) [X G] and to
h^(η+1) [B_g], up to O(N h^(η+3)). What remains is h^(η+2) Σ ⟨g⟩(z_k), as above, and O(N h^(η+3)).
Energy: H(φ_h z) = H(z), so H(Φ z) − H(z) = −h^(η+1)/(η+1)! ∇H · X^(η+1) z + O(h^(η+2)) for `lieη`,
and O(h^(η+1)) for any scheme. With z' = f and ω = dp∧dq, ∇H · X^(η+1) z = ±ω(z', z^(η+1)). Its
derivative rule ω(z^(a), z^(b))' = ω(z^(a+1), z^(b)) + ω(z^(a), z^(b+1)) makes it, for even η, a
derivative along the flow up to ±ω(z^(m), z^(m)) = 0, m = η/2 + 1; by (1) its sum is bounded. ∎

At an equilibrium `lieη` stays, Λ = (1 + ΔJ)^N − 1, and the law holds with ⟨g⟩ = g(z₀) and [ ] = 0,
since X G = 0 there.
"""

from dataclasses import dataclass
from functools import lru_cache

from verify.algebra.ring import Poly, Ring
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.expansion import MOST_ORDERS
from verify.proof.order_for_one_h import prove
from verify.proof.plane.potential import Potential, potential_of
from verify.proof.proof_for_one_h import Proof
from verify.proof.telescoping import potential_of_lie
from verify.prose import read_prose
from verify.schemes import get
from verify.schemes.methods.taylor.lie import eta_of
from verify.schemes.scheme import Scheme

_LIE_POTENTIAL = Potential(True, "by the formula for every H")  # G of `lieη`, even η
Element = tuple[Ring, Poly]


class NoLawError(Exception):
    """There is no growth law; `reason` says why, and the message is its plain text."""

    def __init__(self, reason: str) -> None:
        self.reason = read_prose(reason)
        super().__init__(str(self.reason))


@dataclass(frozen=True)
class GrowthLaw:
    """The law log(1 + Λ) = h^(power−1) [G] + h^power (T ⟨g⟩ + [B_g − ½ X G]) + O(h^(power+1) T).

    For `lieη` of even η, `potential` is G and `leading` is X G. For other schemes both are None,
    and the law has no G. `telescoping`: the answer whether the leading coefficient is X·G; it may
    be for other schemes, too.
    """

    power: int
    g: Element
    potential: Element | None
    leading: Element | None
    telescoping: Potential


@lru_cache(maxsize=64)
def growth_law(hamiltonian: Hamiltonian, scheme: str) -> GrowthLaw:
    """Derive the growth law of a scheme for one H without symbols.

    Raises InputError for a parameter without a value and in n degrees of freedom, NoLawError if
    ΔJ ≡ 0 or its order in h is not known or below 2.
    """
    if hamiltonian.symbols:
        raise InputError(
            "parameter", hamiltonian.symbols[0], "has no value; a growth law needs one"
        )
    hamiltonian.check_planar()
    chosen = get(scheme)
    step_map = chosen.step_map(hamiltonian)
    if step_map.preserves_area:
        raise NoLawError("ΔJ ≡ 0 is proved: Λ is exactly 0")
    eta = eta_of(scheme)
    # Only lieη of even η has the potential G in closed form for every H.
    if eta is None or eta % 2:
        return _plain_law(prove(step_map, chosen), chosen)
    step = step_map.flat
    ring, potential = step.ring, potential_of_lie(step.field, eta).divergence
    leading, g = (step.form(n).entry(0, 1) for n in (eta + 1, eta + 2))
    return GrowthLaw(eta + 1, (ring, g), (ring, potential), (ring, leading), _LIE_POTENTIAL)


def _plain_law(proof: Proof, scheme: Scheme) -> GrowthLaw:
    """Derive the law without G, from the leading coefficient of ΔJ."""
    n, g = proof.first.power, proof.first.element
    if n is None or g is None:
        raise NoLawError(f"the coefficients of ΔJ vanish up to `h^{MOST_ORDERS}`")
    if proof.first.decision.zero is None:
        raise NoLawError(f"whether the coefficient of `h^{n}` in ΔJ vanishes is not decided")
    # The theorem needs r ≥ 2.
    if n < 2:
        raise NoLawError(f"ΔJ begins with `h^{n}`: the map is not consistent with the flow")
    return GrowthLaw(n - 1, g, None, None, potential_of(proof, scheme))
