"""Identities on surfaces with a singular Hessian: of H itself, and of Ψ with ∇Ψ = −X²z.

A function with det Hess = 0 and Hess ≠ 0 has a gradient (a(s), b(s)) that is constant on straight
lines; see `families` for the notation.
"""

from verify.papers.argument import Check, vanishes
from verify.papers.differential_polynomials import (
    Differential,
    DifferentialFlow,
    Poly,
    free_variables,
)


def adjugate_identity() -> Check:
    """Check (v·Yv) Y = (Yv)(Yv)ᵀ + det Y (Sv)(Sv)ᵀ for symmetric Y, Sv = (−v₂, v₁)."""
    y11, y12, y22, v1, v2 = free_variables("y11 y12 y22 v1 v2")
    image = (y11 * v1 + y12 * v2, y12 * v1 + y22 * v2)
    size, det = v1 * image[0] + v2 * image[1], y11 * y22 - y12 * y12
    return vanishes(
        "(v·Yv) Y = (Yv)(Yv)ᵀ + det Y (Sv)(Sv)ᵀ for every symmetric Y and every v",
        size * y11 - image[0] ** 2 - det * v2 * v2,
        size * y12 - image[0] * image[1] + det * v1 * v2,
        size * y22 - image[1] ** 2 - det * v1 * v1,
    )


def contraction(weight: int = 1) -> Check:
    """Check (v·Yv)(u·Yu) = (u·Yv)² + det Y (u·Sv)²; `turned`: the factor of the last term.

    With v = (a, b), u = (a', b'), w = Yv: v·w = Ψ − c, u·w = −c', u·Sv = −ω, and tr (Y Hess Ψ) = 2
    says u·Yu = −2W. That is (3).
    """
    y11, y12, y22, v1, v2, u1, u2 = free_variables("y11 y12 y22 v1 v2 u1 u2")

    def form(a: tuple[Poly, Poly], b: tuple[Poly, Poly]) -> Poly:
        return y11 * a[0] * b[0] + y12 * (a[0] * b[1] + a[1] * b[0]) + y22 * a[1] * b[1]

    v, u, det = (v1, v2), (u1, u2), y11 * y22 - y12 * y12
    # Y is any symmetric matrix: its entries are free, and so are those of u and v.
    side = (u2 * v1 - u1 * v2) ** 2
    return vanishes(
        "(v·Yv)(u·Yu) − (u·Yv)² − det Y (u·Sv)² for every symmetric Y, every u and v",
        form(v, v) * form(u, u) - form(u, v) ** 2 - weight * det * side,
    )


def legendre(sign: int = 1) -> Check:
    """Check ∇(w·∇L − L) = (Hess L) w for a generic L(w); `sign` is that of L."""
    ring = Differential(["x", "y", "L", "L_x", "L_y", "L_xx", "L_xy", "L_yy"])
    x, y, transform, l_x, l_y, xx, xy, yy = (ring[n] for n in ring.names)
    ring.set_coordinates("x", "y")
    ring.set_gradient("L", x=l_x, y=l_y)
    ring.set_gradient("L_x", x=xx, y=xy)
    ring.set_gradient("L_y", x=xy, y=yy)
    energy = x * l_x + y * l_y - sign * transform
    return vanishes(
        "∇(w·∇L − L) − (Hess L) w for a generic L",
        ring.diff(energy, "x") - (xx * x + xy * y),
        ring.diff(energy, "y") - (xy * x + yy * y),
    )


def radial(bent: int = 0) -> Check:
    """Check that κ and ω of (a, b) = r(s) (α, β) are 0; `bent` s is added to b."""
    r, r1, r2, alpha, beta, s = free_variables("r r1 r2 alpha beta s")
    (a, a1, a2), (b, b1, b2) = ([k * x for x in (r, r1, r2)] for k in (alpha, beta))
    # Along a gradient curve that is a multiple of a fixed direction all 2×2 determinants vanish.
    b, b1 = b + bent * s, b1 + bent
    return vanishes(
        "κ and ω of a gradient curve (a, b) = r(s) (α, β)", a1 * b2 - a2 * b1, a1 * b - a * b1
    )


def ruled_hessian(sign: int = 1) -> Check:
    """Check Hess Ψ = −(a', b')ᵀ(a', b')/W where ∇Ψ = (a(s), b(s)) on xa' + yb' + c' = 0.

    That equation defines s, so that W s_x = −a' and W s_y = −b'; `sign` is that of the last.
    """
    ring = Differential(["W", "V", "a", "a1", "b", "b1"])  # V = 1/W
    w, v, _, a1, _, b1 = (ring[n] for n in ring.names)
    ring.relate(w * v - 1)
    # Implicit differentiation of the line's equation gives ∂s = −(a', b')/W.
    slope = {"x": -a1 * v, "y": -sign * b1 * v}
    ring.set_gradient("a", **{z: a1 * slope[z] for z in slope})
    ring.set_gradient("b", **{z: b1 * slope[z] for z in slope})
    entries = [("a", "x", a1 * a1), ("a", "y", a1 * b1), ("b", "x", a1 * b1), ("b", "y", b1 * b1)]
    gaps = [ring.reduce(w * ring.diff(ring[name], by) + entry) for name, by, entry in entries]
    return vanishes("W Hess Ψ + (a', b')ᵀ(a', b')", *gaps)


def comparison(double: int = 2) -> Check:
    """Compare the coefficients of (3), with ω = 1.

    Then (3) is P(Ψ) = −2κ(Ψ − c)² − 2c''(Ψ − c) − c'²; so P(c) = −c'², P'(c) = −2c'' and
    k₂ = −2κ; `double` is the 2 of the first term of (3). As ω' = a''b − ab'' = 0, (a, b)'' is some
    multiple of (a, b), and that is κ.
    """
    ring = Differential(["k", "c", "c1", "c2", "Psi", "a", "a1", "b", "b1"])  # k stands for κ
    kappa, c, c1, c2, psi, a, a1, b, b1 = (ring[n] for n in ring.names)
    ring.set_gradient("Psi", Psi=ring.context.constant(1))
    e = psi - c
    p = -double * e * (c2 + kappa * e) - c1 * c1  # W = c'' + κ(Ψ − c)
    at_c: dict[str | int, Poly] = {"Psi": c}
    slope = ring.diff(p, "Psi")
    return vanishes(
        "P(c) + c'², P'(c) + 2c'' and P'' + 4κ of the P that (3) gives, ω = 1; and a'b'' − a''b' − "
        "κω for (a, b)'' = κ(a, b)",
        a1 * kappa * b - kappa * a * b1 - kappa * (a1 * b - a * b1),
        _substitute(p, at_c) + c1 * c1,
        _substitute(slope, at_c) + 2 * c2,
        ring.diff(slope, "Psi") + 4 * kappa,
    )


def _substitute(x: Poly, values: dict[str | int, Poly]) -> Poly:
    context = x.context()
    gens = [
        values.get(name, gen) for name, gen in zip(context.names(), context.gens(), strict=True)
    ]
    return x.compose(*gens)


def ruling() -> Check:
    """Check ωW = ωc'' − ω'c' + κ(Ψ − c) on the line xa' + yb' + c' = 0, xa + yb + c = Ψ."""
    a, a1, a2, b, b1, b2, c1, c2, e = free_variables("a a1 a2 b b1 b2 c1 c2 e")
    omega, omega_slope, kappa = a1 * b - a * b1, a2 * b - a * b2, a1 * b2 - a2 * b1
    # The point (x, y) where the line of s meets xa + yb + c = Ψ, by Cramer's rule, times ω.
    x, y = -(e * b1 + c1 * b), a * c1 + a1 * e  # ω times the point, e = Ψ − c
    return vanishes(
        "ωW = ωc'' − ω'c' + κ(Ψ − c) on a ruling line, a, b, c generic",
        x * a + y * b - omega * e,
        x * a1 + y * b1 + omega * c1,
        x * a2 + y * b2 + omega * c2 - (omega * c2 - omega_slope * c1 + kappa * e),
    )


def developable() -> Check:
    """Check ΔJ for H with D ≡ 0: ∇H = (a(s), b(s)) on lines pa' + qb' + c' = 0.

    Write W = pa'' + qb'' + c'' and V = 1/W. Then s_p = −a'/W and s_q = −b'/W, and the coefficient
    of h⁴ in ΔJ is −ω²κ²/(4W⁴) with ω = a'b − ab' and κ = a'b'' − a''b'.
    """
    names = ["V", "W", "W3", "a", "a1", "a2", "a3", "b", "b1", "b2", "b3", "h", "p", "q"]
    ring = Differential(names)
    v, w, w3, a, a1, a2, a3, b, b1, b2, b3 = (ring[n] for n in names[:11])
    ring.relate(v * w - 1)
    s = {"p": -a1 * v, "q": -b1 * v}
    for name, derivative in (("a", a1), ("a1", a2), ("a2", a3), ("b", b1), ("b1", b2), ("b2", b3)):
        ring.set_gradient(name, **{z: derivative * s[z] for z in s})
    # ∂W = (a'', b'') + W_s ∂s, with W3 for the derivative of W by s.
    direct = {"p": a2, "q": b2}
    slope = {z: direct[z] + w3 * s[z] for z in s}
    ring.set_gradient("W", **slope)
    ring.set_gradient("V", **{z: -v * v * slope[z] for z in s})
    ring.set_coordinates()
    flow = DifferentialFlow(ring, a, b)
    omega, kappa = a1 * b - a * b1, a1 * b2 - a2 * b1
    gaps = flow.delta_j_gaps(2, h4=-(omega**2) * kappa**2 * v**4 / 4)
    return vanishes(
        "D ≡ 0, ∇H = (a(s), b(s)): D = 0, and ΔJ = −(h⁴/4) ω²κ²/W⁴ with ω = a'b − ab', "
        "κ = a'b'' − a''b'",
        flow.hessian_determinant,
        *map(ring.reduce, gaps),
    )


class Conic:
    """H with D ≠ 0 whose accelerations −(a, b) lie on a curve that is not radial.

    Coordinates s and Ψ; (a, b)'' = −(k₂/2) (a, b), a'b − ab' = 1, c'² = −P(c), c'' = −P'(c)/2,
    P(Ψ) = k₀ + k₁Ψ + k₂Ψ². w = ∇H = (x, y) is where xa + yb + c = Ψ and xa' + yb' + c' = 0; z is
    given by its derivatives, and H by dH = P(Ψ) dΨ.
    """

    def __init__(self, flaw: int = 0) -> None:
        """Set up the ring in s and Ψ; `flaw` is added to c'', as a control."""
        names = ["h", "k0", "k1", "k2", "a1", "b", "c1", "a", "b1", "c", "Psi"]
        ring = self.ring = Differential(names)
        self.h, k0, k1, k2, a1, b, c1, a, b1, c, psi = (ring[n] for n in names)
        self.a, self.b, self.a1, self.b1, self.c1 = a, b, a1, b1, c1
        zero, one = ring.zero, ring.context.constant(1)
        for name, derivative in (
            ("a", a1), ("a1", -k2 * a / 2), ("b", b1), ("b1", -k2 * b / 2),
            ("c", c1), ("c1", -k1 / 2 - k2 * c + flaw),
        ):  # fmt: skip
            ring.set_gradient(name, s=derivative, Psi=zero)
        ring.set_gradient("Psi", s=zero, Psi=one)
        # Leading terms of both relations are coprime, as `Differential.relate` requires.
        ring.relate(a1 * b - a * b1 - 1, c1 * c1 + k0 + k1 * c + k2 * c * c)
        self.p_of_psi = k0 + k1 * psi + k2 * psi * psi
        self.e = psi - c  # x a + y b
        self.w = (-(self.e * b1 + c1 * b), a * c1 + a1 * self.e)
        x, y = self.w
        # (x a + y b) Hess_w L = adj(w wᵀ + P (Sv)(Sv)ᵀ), v = (a, b), Sv = (−b, a)
        p = self.p_of_psi
        self.hessian = (y * y + p * a * a, -(x * y - p * a * b), x * x + p * b * b)

    def derivative(self, by: str) -> tuple[tuple[Poly, Poly], tuple[Poly, Poly]]:
        """Return ∂w and (x a + y b) ∂z, by s or Ψ."""
        reduce, diff = self.ring.reduce, self.ring.diff
        x, y = (diff(z, by) for z in self.w)
        pp, pq, qq = self.hessian
        return (x, y), (reduce(pp * x + pq * y), reduce(pq * x + qq * y))

    def exists(self) -> Check:
        """Check that z is well defined (closed), w = ∇H with H a function of Ψ, and D = 1/P(Ψ)."""
        ring, e = self.ring, self.e
        (w_s, z_s), (w_psi, z_psi) = self.derivative("s"), self.derivative("Psi")
        del w_s, w_psi
        # The derivatives are multiplied by e = Ψ − c, which makes them polynomials. Equality of
        # mixed derivatives, ∂_Ψ(z_s) = ∂_s(z_Ψ), so has terms from e_Ψ = 1 and e_s = −c'.
        closed = [
            e * ring.diff(z_s[i], "Psi")
            - z_s[i]
            - e * ring.diff(z_psi[i], "s")
            - self.c1 * z_psi[i]
            for i in (0, 1)
        ]
        x, y = self.w
        pp, pq, qq = self.hessian
        parts = [
            *closed,
            x * z_s[0] + y * z_s[1],
            x * z_psi[0] + y * z_psi[1] - e * self.p_of_psi,
            pp * qq - pq * pq - e * e * self.p_of_psi,
        ]
        return vanishes(
            "D ≠ 0, conic: ∂z/∂s and ∂z/∂Ψ fit together, w·dz = P(Ψ) dΨ = dH, D P(Ψ) = 1",
            *map(ring.reduce, parts),
        )

    def preserves_area(self) -> Check:
        """Check z'' = −(a, b), and that lie2 preserves det ∂z/∂(s, Ψ) for every h."""
        ring, h, e = self.ring, self.h, self.e
        (w_s, z_s), (w_psi, z_psi) = self.derivative("s"), self.derivative("Psi")
        x, y = self.w
        velocity, velocity_s = (-y, x), (-w_s[1], w_s[0])
        # s' is where z_s s' = f, so that z'' = f_s s'.
        newton = [
            velocity_s[j] * e * velocity[i] + (self.a, self.b)[j] * z_s[i]
            for i in (0, 1)
            for j in (0, 1)
        ]
        # e times the partial derivatives of the step by s and by Ψ.
        first = [
            z_s[i] + e * h * velocity_s[i] - e * h * h / 2 * (self.a1, self.b1)[i] for i in (0, 1)
        ]
        second = [z_psi[i] + e * h * (-w_psi[1], w_psi[0])[i] for i in (0, 1)]
        after = first[0] * second[1] - first[1] * second[0]
        before = z_s[0] * z_psi[1] - z_s[1] * z_psi[0]
        return vanishes(
            "D ≠ 0, conic: X²z = −(a, b), and ΔJ of lie2 is 0 for all h, k₀, k₁, k₂",
            *map(ring.reduce, [*newton, after - before]),
        )
