"""How Λ grows for even η: bounded at h^η, and in proportion to the time one power of h later."""

from verify.papers.argument import Argument, proof, vanishes
from verify.papers.differential_polynomials import flow_of_every_hamiltonian


def growth_of_lambda() -> Argument:
    """Prove log(1 + Λ) = h^η [G] + h^(η+1) (∫ g dt − ½ [X G]) + O(h^(η+2) T) for even η."""
    flow = flow_of_every_hamiltonian(4)
    telescopes = vanishes(
        "the coefficient of h³ in ΔJ of lie2 is X·G for a generic H, with G = det Hess H/2",
        flow.delta_j_gaps(2, h3=flow.derive(flow.hessian_determinant / 2))[2],
    )
    return proof(
        """
        for even η log(1 + Λ) = `h^η` [G] + `h^(η+1)` (∫ g dt − ½ [X·G]) + O(`h^(η+2)` (1 + T))
        while the orbit stays in a compact set, so |Λ| ≤ `C₁` `h^η` + `C₂` `h^(η+1)` T as long as
        that is at most 1: O(`h^η`) for T up to 1/h; what may grow beyond is `h^(η+1)` ∫ g dt

        Let H be smooth, η even, K compact, and h small enough; let `z_0`, …, `z_N` lie in K, T =
        Nh. X is the derivative along the flow, [F] the difference of F between the two ends, and ∫
        g dt stands for h Σ g(`z_k`), the integral along the computed orbit up to O(h).

        - ΔJ of `lieη` begins with a derivative along the flow: ``ΔJ = h^(η+1) X·G + h^(η+2) g +
          O(h^(η+3))``, uniformly on K. log(1 + ΔJ) begins with the same two terms, as 2(η + 1) ≥ η
          + 3. [telescopes, Theorems.lie_telescopes_in_plane_for_even]
        - The step is the exact flow up to O(`h^(η+1)`), and η ≥ 2, so that by Taylor’s formula
          ``F(z_{k+1}) − F(z_k) = h X·F + (h^2/2) X·X·F + O(h^3)`` for every smooth F, uniformly on
          K.
        - With F = G, summed over k: ``h^(η+1) Σ_{k} X·G(z_k) = h^η [G] − (h^(η+2)/2) Σ_{k}
          X·X·G(z_k) + O(N h^(η+3))``, [G] being G(`z_N`) − G(`z_0`).
        - With F = X·G: ``h Σ_{k} X·X·G(z_k) = [X·G] + O(N h^2)``, so that the sum in the last step
          is −½ `h^(η+1)` [X·G] up to O(N `h^(η+3)`), which is O(`h^(η+2)` T).
        - What is left is `h^(η+2)` Σ g(`z_k`) = `h^(η+1)` ∫ g dt, and O(N `h^(η+3)`) = O(`h^(η+2)`
          T).
        - So |log(1 + Λ)| ≤ `c₁` `h^η` + `c₂` `h^(η+1)` T with `c₁`, `c₂` of H, η and K alone, and
          |`e^x` − 1| ≤ 2 |x| for |x| ≤ 1 gives the bound of Λ.

        With g = `c_{η+2}`, the next coefficient of ΔJ. On a closed orbit ∫ g dt = T ⟨g⟩ + a bounded
        part, and the growth law of each system below has these numbers.
        """,
        telescopes=telescopes,
    )
