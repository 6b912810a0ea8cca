"""Identities of matrices of the plane: determinants of products, and the derivative of a field."""

import sympy

from verify.papers.checks.check import Check, same, vanishes
from verify.papers.checks.differential import Poly, flow_of_every_hamiltonian, free_variables

Matrix = tuple[tuple[Poly, Poly], tuple[Poly, Poly]]


def product_of_determinants(sign: int = 1) -> Check:
    """det (AB) = det A det B, all entries free; `sign` is that of one entry of the product."""
    a, b, c, d, e, f, g, h = free_variables("a b c d e f g h")
    product = ((a * e + sign * b * g, a * f + b * h), (c * e + d * g, c * f + d * h))
    return vanishes(
        "det (AB) − det A det B, all entries free",
        _det(product) - _det(((a, b), (c, d))) * _det(((e, f), (g, h))),
    )


def of_the_field(trace: int = 0) -> Check:
    """A = f' of a generic H: A² = −D, and det (x + yA) = x² + y² D; `trace` is added to A."""
    x, y, pp, pq, qq = free_variables("x y H2_0 H1_1 H0_2")
    (a, b), (c, d) = field = ((-pq + trace, -qq), (pp, pq))
    det = pp * qq - pq * pq
    square = (a * a + b * c + det, a * b + b * d, c * a + d * c, c * b + d * d + det)
    return vanishes(
        "A² + D and det (x + yA) − (x² + y² D) for A = f' of a generic H, D = det Hess H",
        *square,
        _det(((x + y * a, y * b), (y * c, x + y * d))) - (x * x + y * y * _det(field)),
        _det(field) - det,
    )


def where_it_rests(weight: int = 1) -> Check:
    """(X g)' = g'A where f = 0, for generic g and H; `weight` is that of one term."""
    flow = flow_of_every_hamiltonian(2, ["g", "g_p", "g_q", "g_pp", "g_pq", "g_qq"])
    ring = flow.ring
    ring.set_gradient("g", p=ring["g_p"], q=ring["g_q"])
    ring.set_gradient("g_p", p=ring["g_pp"], q=ring["g_pq"])
    ring.set_gradient("g_q", p=ring["g_pq"], q=ring["g_qq"])
    along = flow.derive(ring["g"])
    pp, pq, qq = flow.hessian
    told = {
        "p": -ring["g_p"] * pq + weight * ring["g_q"] * pp,
        "q": -ring["g_p"] * qq + ring["g_q"] * pq,
    }
    rests: dict[str | int, int] = {"H1_0": 0, "H0_1": 0}
    gaps = [(ring.diff(along, by) - told[by]).subs(rests) for by in told]
    return vanishes("(X g)' − g'A where `H_p` = `H_q` = 0, g and H generic", *gaps)


def stretching(factor: int = 1) -> Check:
    """The symmetric part of f' has the square s² = H_pq² + (H_pp − H_qq)²/4; `factor` of H_pq²."""
    pp, pq, qq = sympy.symbols("H_pp H_pq H_qq")
    field = sympy.Matrix([[-pq, -qq], [pp, pq]])
    part = (field + field.T) / 2
    square = factor * pq**2 + (pp - qq) ** 2 / 4
    what = (
        "the symmetric part of f' squared is s² times the unit matrix, s² = `H_pq²` + (`H_pp` − "
        "`H_qq`)²/4"
    )
    gap = part * part - square * sympy.eye(2)
    return same(what, list(gap), ("H_pp", "H_pq", "H_qq"), "exactly")


def _det(matrix: Matrix) -> Poly:
    (a, b), (c, d) = matrix
    return a * d - b * c
