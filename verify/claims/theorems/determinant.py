"""“The value of the determinant cannot always be equal to 1”: for which H it is."""

import math
from collections.abc import Sequence

import sympy

from verify.algebra.formula import to_text
from verify.claims.theorems import developables, families
from verify.claims.theorems.argument import Argument, Check, concluded
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order import convergence_of, prove
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.step_map import H_STEP, P, Q
from verify.verdict import Verdict

SYSTEMS = ("duffing", "pendulum")
ETAS = range(1, 6)
# det J = 1 exactly, and the scheme is not the flow.
PRESERVED = ("p**3/6 + q", "(p**2 + q**2)**(3/4)", "(p*q)**(3/4)")
SINGULAR = "q**2/p"  # det Hess H = 0 everywhere, and still ΔJ ≠ 0


def examples(names: Sequence[str] = SYSTEMS) -> Argument:
    """For the paper's two systems det J ≠ 1: at the equilibrium, for every η and almost every h."""
    at_rest = [_at_rest(name, eta) for name in names for eta in ETAS]
    return concluded(
        "determinant-of-the-examples",
        Verdict.PROVED,
        "wherever H has an equilibrium with D = det Hess H ≠ 0, as both systems have at (0, 0), "
        "det J of lie2 is 1 + h⁴D²/4 there, and for every η it is 1 for finitely many h only",
        """At a critical point z₀ of H, where f = (−`H_q`, `H_p`) = 0, the derivative of X g = g'f
        is g''f + g'A = g'A with A = f'(z₀), so the derivative of Xⁿz is Aⁿ and J = R(hA), R the
        truncated exponential of degree η. A has trace 0 and determinant D = det Hess H(z₀), hence
        eigenvalues ±μ with μ² = −D, and det J = R(hμ) R(−hμ): a polynomial in h of degree 2η whose
        coefficient of `h^(2η)` is `(−1)^η` `μ^(2η)`/(η!)² = `D^η`/(η!)². If D ≠ 0 it is not
        constant, so det J = 1 at z₀ for at most 2η values of h. For η = 2 it is 1 + h⁴D²/4 > 1 for
        every h > 0. The Duffing oscillator (for every δ) and the pendulum have D = 1 at (0, 0): for
        them the sentence is right, whatever η is. ∎""",
        [families.equilibrium(), *at_rest],
    )


def _at_rest(name: str, eta: int) -> Check:
    """ΔJ at (0, 0) against R(ih) R(−ih) − 1, all parameters symbols."""
    hamiltonian = Hamiltonian(systems.get(name).hamiltonian().expression)
    delta_j = sympy.expand(lie_map(hamiltonian, eta).delta_j.subs({P: 0, Q: 0}))
    # R(z) R(−z) at z² = −h²
    z = sympy.Symbol("z")
    terms = [z**n / sympy.factorial(n) for n in range(eta + 1)]
    product = sympy.expand(sum(terms) * sum(t.subs(z, -z) for t in terms))
    told = sympy.expand(product.subs(z, sympy.I * H_STEP)) - 1
    top = sympy.Poly(delta_j, H_STEP).coeff_monomial(H_STEP ** (2 * eta)) if delta_j != 0 else 0
    return Check(
        f"{name}, lie{eta}: ΔJ at (0, 0) is R(ih) R(−ih) − 1, its last coefficient 1/({eta}!)²",
        delta_j == told and top == sympy.Rational(1, math.factorial(eta) ** 2),
        f"`{to_text(delta_j)}`",
    )


def universal(formulas: Sequence[str] = PRESERVED) -> Argument:
    """As a statement on every H: refuted by H with det J ≡ 1 and a truncation error."""
    return concluded(
        "determinant-of-every-h",
        Verdict.REFUTED,
        "for H = p³/6 + q the local error of lie2 is h³/6 in q, and det J = 1 for all p, q, h; "
        "so it "
        "is for H = `(p² + q²)^(3/4)`, where lie2 spirals outwards; see the classification",
        """For H = p³/6 + q one has p' = p − h and q' = q + h p²/2 − h² p/2, while the exact flow
        has another h³/6 in q: the local truncation error is not 0, and J is triangular with ones on
        its diagonal, so det J = 1 for all p, q and h. For H = `(p² + q²)^(3/4)` away from the
        origin write I = (p² + q²)/2: the flow turns each circle with the frequency Ω(I) = dH/dI,
        proportional to `I^(−1/4)`, and a step of lie2 turns it by an angle that depends on I alone
        and takes I to I (1 + h⁴Ω⁴/4) = I + const · h⁴. In the coordinates (I, angle), in which
        areas are dI dφ, that has determinant 1: lie2 preserves area exactly, although the energy
        grows in every step. A truncation error is thus no reason for det J ≠ 1. In general ΔJ of
        lie2 is (h³/2) X D + (h⁴/4) (D² + det T), D = det Hess H, `T_ij` = `Σ_k` `∂_j` adj`(Hess
        H)_ik` `∂_k` H, so det J = 1 for all h (or for two values h > 0) if and only if X D = 0 and
        det T = −D². D = 0 everywhere is not enough: H = q²/p has D = 0 and ΔJ = −h⁴q⁴/p⁸. For H =
        T(p) + V(q) it is the case if and only if T'' = 0 or V'' = 0, for a polynomial H if and only
        if H = F(ℓ) + m or H = F(ℓ + m²) with linear functions ℓ, m of p and q. ∎""",
        [*map(_preserved, formulas), _singular(), families.linear(), families.coefficients()],
    )


def _preserved(formula: str) -> Check:
    """ΔJ ≡ 0 by the ring, and the map agrees with the flow up to h² and not further."""
    step = lie_map(Hamiltonian.parse(formula), 2)
    found, agreement = prove(step), convergence_of(step)
    return Check(
        f"H = `{formula}`: det J ≡ 1, and the local error of lie2 is of order h³ exactly",
        found.area_preserving is True and agreement.decided and agreement.order == 2,
        f"ΔJ = `{to_text(step.delta_j)}`, agrees with the flow up to `h^{agreement.order}`",
    )


def _singular() -> Check:
    hamiltonian = Hamiltonian.parse(SINGULAR)
    hessian = sympy.hessian(hamiltonian.expression, (P, Q)).det()
    found = prove(lie_map(hamiltonian, 2))
    told = -(H_STEP**4) * Q**4 / P**8
    return Check(
        f"H = `{SINGULAR}`: det Hess H = 0 and ΔJ is not 0",
        sympy.simplify(hessian) == 0 and found.order == 4 and found.delta_j == told,
        f"ΔJ = `{to_text(found.delta_j)}`",
    )


def classification(flaw: int = 0) -> Argument:
    """All H for which lie2 preserves area exactly; `flaw` spoils the conic family."""
    conic = developables.Conic(flaw)
    return concluded(
        "determinant-classification",
        Verdict.PROVED,
        "locally complete for smooth H, near the points of an open dense set, globally for "
        "polynomial H and for "
        "H = T(p) + V(q); open is only how pieces of different families may fit together in one H "
        "that is smooth but not analytic",
        _CLASSIFICATION,
        [
            families.coefficients(),
            families.acceleration(),
            families.separable(),
            families.linear(),
            families.parabolic(),
            families.exact_flow(),
            developables.developable(),
            developables.adjugate_identity(),
            developables.ruling(),
            conic.exists(),
            conic.preserves_area(),
            *map(_preserved, PRESERVED),
        ],
    )


_CLASSIFICATION = """Write w = ∇H, D = det Hess H, N = −X²z. By algebra for a generic H, ΔJ = (h³/2)
X D + (h⁴/4) det N', N = adj(Hess H) w and div N = 2D. So ΔJ = 0 for all h if and only if (1) X D =
0 and (2) det N' = 0. Case D = 0 on an open set. Where Hess H ≠ 0 the gradient is constant on lines:
w = (a(s), b(s)), pa' + qb' + c' = 0, and ΔJ = −(h⁴/4) ω²κ²/W⁴, ω = a'b − ab', κ = a'b'' − a''b', W
= pa'' + qb'' + c''. Where κ ≠ 0 one would need ω = 0, a radial gradient curve, on which κ = 0; so κ
= 0, w moves on a straight line, and H = F(ℓ) + m with linear ℓ and m; where Hess H = 0, H is linear
itself. Case D ≠ 0. Then w ≠ 0, for at a critical point N' has determinant D². By (1) D is a
function of H; w are coordinates, and with the Legendre transform L(w) = w·z − H one has H = w·∇L −
L, so `∇_w` H = (Hess L) w and N = D (Hess L) w = `∇_w` Ψ where dΨ = D dH. (2) says that `Hess_w` Ψ
is singular; it is not 0, as div N = 2D ≠ 0. So v = `∇_w` Ψ = (a(s), b(s)) on the lines xa' + yb' +
c' = 0 of the plane of w = (x, y), with Ψ = xa + yb + c and Hess Ψ = −(a', b')ᵀ(a', b')/W, now with
W = xa'' + yb'' + c''. The symmetric matrix Y = adj(Hess L) has Y v = w, det Y = 1/D =: P(Ψ), and tr
(Y Hess Ψ) = 2, which is div N = 2D. From (v·Yv) Y = (Yv)(Yv)ᵀ + det Y (Sv)(Sv)ᵀ, Sv = (−b, a), it
follows that (3) 2(Ψ − c) W + c'² + P(Ψ) ω² = 0. If ω = 0 near a point, v has a fixed direction: in
suitable linear coordinates Ψ = F(x), and the same identity reads 2xF' = x²F'', so F' = Cx², p'' =
−C `H_p²` and q'' = 0. Then `H_p` is a function of H, hence H = R(p + c(q)), p'' = −R'² c'' gives
c'' = C: H = F(ℓ + m²), and X³z = 0, so that lie2 is the flow itself. If ω ≠ 0, Ψ is a coordinate on
each line, with ωW = ωc'' − ω'c' + κ(Ψ − c); by (3) P is a polynomial k₀ + k₁Ψ + k₂Ψ² with constant
coefficients, and with the parameter s chosen so that ω = 1, comparing coefficients gives (a, b)'' =
−(k₂/2)(a, b), c'² = −P(c), c'' = −P'(c)/2. Conversely, for all solutions of these equations with W,
P and Ψ − c not 0 the H with dH = P(Ψ) dΨ exists, P = 1/D, and ΔJ = 0, by algebra in s and Ψ.
(Examples: c = 0 gives the powers 3/4 of definite and indefinite quadratic forms.) Polynomial H: if
D = 0, or in the second case, the form found near one point holds everywhere, for it says that a
polynomial (H − m, or H in the coordinates ℓ + m² and m) does not depend on one of two variables. In
the third case H = g(Ψ) with g' = P, D P(Ψ) = 1; eliminating Ψ, the resultant of g(Ψ) − H and D P(Ψ)
− 1 is a polynomial identity in p and q, true on ℂ², so at every complex point some Ψ solves both: D
has no zero, D is a constant, P(Ψ) = 1/D leaves finitely many values for Ψ and H = g(Ψ), unless P is
constant, that is k₁ = k₂ = 0, where W = −k₁/2 − k₂(Ψ + c)/2 = 0 is excluded; so H is constant,
which contradicts D ≠ 0. H = T(p) + V(q) of class C³ on a rectangle: let T''V'' ≠ 0 near a point.
The coefficient of h⁴ gives (T'T'''/T''²)(V'V'''/V''²) = 1, so the first factor is a constant λ ≠ 0
and the second 1/λ; that of h³ gives T'''/(T'T'') = V'''/(V'V'') = c, a constant. Then λT'' = cT'²,
whose derivative is λT''' = 2cT'T'' = 2T''', so λ = 2; likewise 1/λ = 2, a contradiction. So T'' = 0
or V'' = 0, and then det J = 1. ∎"""


THEOREMS = {
    "determinant-of-the-examples": examples,
    "determinant-of-every-h": universal,
    "determinant-classification": classification,
}
