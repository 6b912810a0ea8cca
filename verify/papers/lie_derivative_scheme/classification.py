"""All Hamiltonians for which lie2 preserves area exactly: their classification, step by step."""

from verify.papers.argument import Argument, Step, proof, steps
from verify.papers.lie_derivative_scheme import developables, families
from verify.papers.lie_derivative_scheme.determinant import PRESERVED, area_is_preserved


def determinant_classification(flaw: int = 0) -> Argument:
    """Classify all H for which lie2 preserves area exactly; `flaw` spoils the conic family."""
    return proof(
        """
        the list is complete near the points of an open dense set for smooth H, and everywhere for
        polynomial H and for H = T(p) + V(q); only how pieces of different families may fit together
        in one H that is smooth but not analytic is left open

        Write w = ∇H, D = det Hess H, N = −X²z.

        - By algebra for a generic H ``ΔJ = (h^3/2) X D + (h^4/4) det N'``, with N = adj(Hess H) w
          and div N = 2D. So ΔJ = 0 for all h if and only if (1) X D = 0 and (2) det N' = 0.
          [coefficients, acceleration, by_acceleration]
        - [without_curvature]
        - [with_curvature]
        - [conic]
        - [polynomial]
        - [separable]
        """,
        coefficients=families.coefficients(),
        acceleration=families.acceleration(),
        by_acceleration=families.by_acceleration(),
        without_curvature=_without_curvature(),
        with_curvature=_with_curvature(),
        conic=_conic(flaw),
        polynomial=_polynomial(),
        separable=_separable(),
    )


def _without_curvature() -> list[Step]:
    """Treat the case D = 0 on an open set."""
    return steps(
        """
        - Case D = 0 on an open set. Where Hess H ≠ 0 the gradient is constant on lines: w = (a(s),
          b(s)) where ``p a' + q b' + c' = 0``.
        - Then, with ω = a'b − ab', κ = a'b'' − a''b' and W = pa'' + qb'' + c'', ``ΔJ = −(h^4/4)
          ω^2κ^2/W^4``. [developable]
        - Where κ ≠ 0 one would need ω = 0, a radial gradient curve, (a, b) = r(s) (α, β), on which
          κ = 0. [radial]
        - So κ = 0, w moves on a straight line, and H = F(ℓ) + m with linear ℓ and m; where Hess H =
          0, H is linear itself.
        - Conversely H = F(ℓ) + m has ΔJ = 0. [linear]
        """,
        developable=developables.developable(),
        radial=developables.radial(),
        linear=families.linear(),
    )


def _with_curvature() -> list[Step]:
    """Treat D ≠ 0 by the Legendre transform, with one identity for the rest."""
    return steps(
        """
        - Case D ≠ 0. Then w ≠ 0, for at a critical point ``ΔJ = h^4 D^2/4``. [equilibrium]
        - w are coordinates, and with the Legendre transform L(w) = w·z − H one has H = w·∇L − L, so
          that ``∇_w H = (Hess L) w``. [legendre]
        - By (1) D is a function of H. So N = D (Hess L) w = `∇_w` Ψ where dΨ = D dH. (2) says that
          Hess Ψ, taken by w, is singular; it is not 0, as div N = 2D ≠ 0.
        - So v = `∇_w` Ψ = (a(s), b(s)) on the lines xa' + yb' + c' = 0 of the plane of w = (x, y),
          with Ψ = xa + yb + c.
        - There, now with W = xa'' + yb'' + c'', ``Hess Ψ = −(a', b')ᵀ(a', b')/W``. [ruled_hessian]
        - The symmetric matrix Y = adj(Hess L) has Y v = w, det Y = 1/D =: P(Ψ), and tr (Y Hess Ψ) =
          2, which is div N = 2D.
        - With Sv = (−b, a) ``(v·Yv) Y = (Yv)(Yv)ᵀ + det Y (Sv)(Sv)ᵀ``, and from that follows ``2(Ψ
          − c) W + c'^2 + P(Ψ) ω^2 = 0``, which is (3). [adjugate_identity, contraction]
        """,
        equilibrium=families.equilibrium(),
        legendre=developables.legendre(),
        ruled_hessian=developables.ruled_hessian(),
        adjugate_identity=developables.adjugate_identity(),
        contraction=developables.contraction(),
    )


def _conic(flaw: int) -> list[Step]:
    """Show that the two families with D ≠ 0 exist and preserve area."""
    conic = developables.Conic(flaw)
    return steps(
        """
        - If ω = 0 near a point, v has a fixed direction: in suitable linear coordinates Ψ = F(x),
          and the same identity reads 2xF' = x²F'', so F' = Cx², p'' = −C `H_p²` and q'' = 0. Then
          `H_p` is a function of H, hence H = R(p + c(q)), and p'' = −R'² c'' gives c'' = C.
        - That is H = F(ℓ + m²). There ΔJ = 0, and X³z = 0, so that lie2 is the flow itself.
          [parabolic, exact_flow]
        - If ω ≠ 0, Ψ is a coordinate on each line, with ``ωW = ωc'' − ω'c' + κ(Ψ − c)``. [ruling]
        - By (3) P is a polynomial k₀ + k₁Ψ + k₂Ψ², and its coefficients are constant: they depend
          on s alone, and P on Ψ alone.
        - With the parameter s chosen so that ω = 1, comparing coefficients gives ``(a, b)'' =
          −(k_2/2)(a, b)``, ``c'^2 = −P(c)``, ``c'' = −P'(c)/2``. [comparison]
        - Conversely, for all solutions of these equations with W, P and Ψ − c not 0 the H with dH =
          P(Ψ) dΨ exists, P = 1/D, and ΔJ = 0, by algebra in s and Ψ. [exists, preserves_area]
        - Examples: the powers 3/4 of definite and indefinite quadratic forms, with c = 0.
          [area_is_preserved]
        """,
        parabolic=families.parabolic(),
        exact_flow=families.exact_flow(),
        ruling=developables.ruling(),
        comparison=developables.comparison(),
        exists=conic.exists(),
        preserves_area=conic.preserves_area(),
        area_is_preserved=map(area_is_preserved, PRESERVED),
    )


def _polynomial() -> list[Step]:
    return steps(
        """
        - Polynomial H: if D = 0, or in the second case, the form found near one point holds
          everywhere, for it says that a polynomial (H − m, or H in the coordinates ℓ + m² and m)
          does not depend on one of two variables.
        - In the third case H = g(Ψ) with g' = P, D P(Ψ) = 1. Eliminating Ψ, the resultant of g(Ψ) −
          H and D P(Ψ) − 1 is a polynomial identity in p and q, true on ℂ², so at every complex
          point some Ψ solves both: D has no zero, and is a constant.
        - P(Ψ) = 1/D then leaves finitely many values for Ψ and H = g(Ψ), unless P is constant, that
          is k₁ = k₂ = 0, where W = −k₁/2 − k₂(Ψ + c)/2 = 0 is excluded; so H is constant, which
          contradicts D ≠ 0.
        """,
    )


def _separable() -> list[Step]:
    return steps(
        """
        - H = T(p) + V(q) of class C³ on a rectangle: let T''V'' ≠ 0 near a point. There ``ΔJ =
          (h^3/2)(T'T''V''' − V'V''T''') + (h^4/4)(T''^2V''^2 − T'T'''V'V''')``. [separable]
        - The coefficient of h⁴ gives (T'T'''/T''²)(V'V'''/V''²) = 1, so the first factor is a
          constant λ ≠ 0 and the second 1/λ; that of h³ gives T'''/(T'T'') = V'''/(V'V'') = c, a
          constant.
        - Then λT'' = cT'², whose derivative is ``λT''' = 2cT'T'' = 2T'''``, so λ = 2; likewise 1/λ
          = 2, a contradiction. So T'' = 0 or V'' = 0, and then det J = 1. [twice]
        """,
        separable=families.separable(),
        twice=families.twice(),
    )
