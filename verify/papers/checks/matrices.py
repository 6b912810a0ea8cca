"""Identities of matrices of the plane: determinants of products, and the derivative of a field."""

import sympy

from verify.papers.checks.check import Check, same, vanishes
from verify.papers.checks.differential import Poly, flow_of_every_hamiltonian, free_variables

Matrix = tuple[tuple[Poly, Poly], tuple[Poly, Poly]]


def product_of_determinants(sign: int = 1) -> Check:
    """Check det (AB) = det A det B, all entries free; `sign` is that of one entry of AB."""
    a, b, c, d, e, f, g, h = free_variables("a b c d e f g h")
    product = ((a * e + sign * b * g, a * f + b * h), (c * e + d * g, c * f + d * h))
    return vanishes(
        "det (AB) − det A det B, all entries free",
        _det(product) - _det(((a, b), (c, d))) * _det(((e, f), (g, h))),
    )


def derivative_of_the_field(trace: int = 0) -> Check:
    """Check A² = −D and det (x + yA) = x² + y² D for A = f' of a generic H.

    `trace` is added to an entry of A, as a control.
    """
    x, y, pp, pq, qq = free_variables("x y H2_0 H1_1 H0_2")
    (a, b), (c, d) = field = ((-pq + trace, -qq), (pp, pq))
    det = pp * qq - pq * pq
    # The Cayley–Hamilton identity A² − (tr A) A + det A = 0 with tr A = 0.
    square = (a * a + b * c + det, a * b + b * d, c * a + d * c, c * b + d * d + det)
    return vanishes(
        "A² + D and det (x + yA) − (x² + y² D) for A = f' of a generic H, D = det Hess H",
        *square,
        _det(((x + y * a, y * b), (y * c, x + y * d))) - (x * x + y * y * _det(field)),
        _det(field) - det,
    )


def derivative_at_rest(weight: int = 1) -> Check:
    """Check (X g)' = g'A at points where f = 0, for generic g and H; `weight`: of one term."""
    flow = flow_of_every_hamiltonian(2, ["g", "g_p", "g_q", "g_pp", "g_pq", "g_qq"])
    ring = flow.ring
    ring.set_gradient("g", p=ring["g_p"], q=ring["g_q"])
    ring.set_gradient("g_p", p=ring["g_pp"], q=ring["g_pq"])
    ring.set_gradient("g_q", p=ring["g_pq"], q=ring["g_qq"])
    derivative = flow.derive(ring["g"])
    pp, pq, qq = flow.hessian
    expected = {
        "p": -ring["g_p"] * pq + weight * ring["g_q"] * pp,
        "q": -ring["g_p"] * qq + ring["g_q"] * pq,
    }
    # At an equilibrium the terms with second derivatives of g vanish: each has a factor H_p or H_q.
    rests: dict[str | int, int] = {"H1_0": 0, "H0_1": 0}
    gaps = [(ring.diff(derivative, by) - expected[by]).subs(rests) for by in expected]
    return vanishes("(X g)' − g'A where `H_p` = `H_q` = 0, g and H generic", *gaps)


def stretching(factor: int = 1) -> Check:
    """Check that the square of the symmetric part of f' is s² = H_pq² + (H_pp − H_qq)²/4.

    `factor`: of H_pq² in s², 1 as it should be.
    """
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
