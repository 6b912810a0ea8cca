"""The implicit midpoint rule: z' = z + h f((z + z')/2), for one H where that can be solved.

For a quadratic H, f is linear, f(z + d) = f(z) + A d, and d = z' − z solves (1 − hA/2) d = h f(z).
By Cramer's rule d is then written down, with the determinant 1 + (h²/4) det Hess H below.
"""

from fractions import Fraction

from verify.errors import InputError
from verify.generic import Stage, StageEquations
from verify.hamiltonian import Hamiltonian
from verify.scheme import Scheme
from verify.step_map import H_STEP, P, Q, StepMap

_ONE = Fraction(1)
EXAMPLES = ("implicit-midpoint",)


def make(name: str) -> Scheme | None:
    if name != EXAMPLES[0]:
        return None
    return Scheme(
        name=name,
        order=2,
        area_preserving=True,
        explicit=False,
        symmetric=True,
        source="Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2 and VI.4",
        build=midpoint_map,
        generic=StageEquations((Stage(kick=_ONE, drift=_ONE, at_p=_ONE / 2, at_q=_ONE / 2),)),
    )


def midpoint_map(hamiltonian: Hamiltonian) -> StepMap:
    """The solved map; InputError unless H is quadratic."""
    field, _ = hamiltonian.field()
    ring = field.ring
    hessian = [ring.diff(x, name) for x in (field.h_p, field.h_q) for name in ("p", "q")]
    if any(ring.decide(ring.diff(x, n)).zero is not True for x in hessian for n in ("p", "q")):
        raise InputError(
            "hamiltonian",
            str(hamiltonian.expression),
            "implicit-midpoint is implicit; for one H it is solved only where H is quadratic, and "
            "--every-hamiltonian proves it for all",
        )
    h_p, h_q, h_pp, h_pq, _, h_qq = map(ring.expression, (field.h_p, field.h_q, *hessian))
    half = H_STEP / 2
    below = 1 + half**2 * (h_pp * h_qq - h_pq**2)
    u = (-h_q * (1 - half * h_pq) - half * h_qq * h_p) / below
    v = (h_p * (1 + half * h_pq) - half * h_pp * h_q) / below
    return StepMap.from_expressions(hamiltonian, P + H_STEP * u, Q + H_STEP * v)
