"""Eq. 2–5: the scheme is the truncated exponential of hX; Eq. 3 as printed is not."""

from collections.abc import Callable

import sympy

from verify.algebra.formula import symbol
from verify.algebra.symbols import H_STEP, P, Q
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import Argument, ArgumentTexts, Check, same, vanishes
from verify.papers.differential_polynomials import DifferentialFlow, Poly, flow_of_every_hamiltonian
from verify.papers.lie_derivative_scheme.examples import SYSTEMS, with_symbols
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

MOST = 5  # powers of X looked at for a generic H; the rest is by induction
Recursion = Callable[[DifferentialFlow, Poly], Poly]


def eq_4(flow: DifferentialFlow, y: Poly) -> Poly:
    """Return Lⁿ from y = Lⁿ⁻¹ by Eq. 4, with both operators as Eq. 5 defines them."""
    along_q = flow.h_p * flow.ring.diff(y, "q")
    along_p = -flow.h_q * flow.ring.diff(y, "p")
    return along_p + along_q


def printed_step(hamiltonian: Hamiltonian, eta: int) -> tuple[sympy.Expr, sympy.Expr]:
    """Return p', q' by Eq. 2, 4 and 5 with sympy's derivatives, from L q = H_p, L p = −H_q."""
    h_p, h_q = (sympy.diff(hamiltonian.expression, z) for z in (P, Q))
    # Plain sympy derivatives share no code with the step map with which this is compared.
    images = []
    for start, first in ((P, -h_q), (Q, h_p)):
        total, power = start, first
        for n in range(1, eta + 1):
            total += H_STEP**n / sympy.factorial(n) * power
            power = h_p * sympy.diff(power, Q) - h_q * sympy.diff(power, P)
        images.append(total)
    return images[0], images[1]


def lie_exponential(recursion: Recursion = eq_4, eta: int = 4) -> Argument:
    """Prove that Eq. 2 with Eq. 4 and 5 is the exponential series of hX, truncated after h^η."""
    powers = [powers_of(name, recursion) for name in ("p", "q")]
    for_systems = []
    for name in SYSTEMS:
        hamiltonian = with_symbols(name)
        for order in range(1, eta + 1):
            for_systems.append(_same(name, hamiltonian, order))
    return _TEXTS.proof(
        "lie_exponential",
        operators=_operators(recursion),
        powers=powers,
        for_systems=for_systems,
        most=str(MOST),
    )


def _operators(recursion: Recursion) -> Check:
    """Check that both operators of Eq. 5 together are X, whatever they are applied to."""
    flow = flow_of_every_hamiltonian(1, ["y", "y_p", "y_q"])
    ring = flow.ring
    # y is a generic function, of which only its gradient is used.
    ring.set_gradient("y", p=ring["y_p"], q=ring["y_q"])
    return vanishes(
        "Eq. 4 and 5 applied to a generic y, less X y",
        recursion(flow, ring["y"]) - flow.derive(ring["y"]),
    )


def powers_of(name: str, recursion: Recursion = eq_4) -> Check:
    """Check that Eq. 4 and 5 give the n-th time derivative of p or q, for a generic H."""
    flow = flow_of_every_hamiltonian(MOST)
    powers = flow.lie_derivatives(name, MOST)
    gaps = [recursion(flow, powers[n - 1]) - powers[n] for n in range(1, MOST + 1)]
    return vanishes(f"Eq. 4 and 5 give Lⁿ = Xⁿ {name} for a generic H, n = 1 … {MOST}", *gaps)


def _same(name: str, hamiltonian: Hamiltonian, eta: int) -> Check:
    step_map = lie_map(hamiltonian, eta)
    printed = printed_step(hamiltonian, eta)
    gaps = [x - y for x, y in zip(printed, (step_map.p_next, step_map.q_next), strict=True)]
    statement = f"{name}: Eq. 2–5 by plain differentiation against the step map of lie{eta}"
    return same(statement, gaps, ("p", "q", "h", *hamiltonian.parameters), "the same")


def eq_3(coordinate: str = "p") -> Argument:
    """Refute Eq. 3 as printed, L_{H_p}(p_k) = H_p ∂q/∂p = H_p.

    `coordinate`: the one to which L_{H_p} is applied.


    With `q` the equation is right, and so it is not refuted.
    """
    flow = flow_of_every_hamiltonian(2)
    ring, h_p = flow.ring, flow.h_p
    literal = h_p * ring.diff(ring["q"], coordinate)
    by_eq_5 = h_p * ring.diff(ring[coordinate], "q")
    as_printed = Check(
        f"`H_p` ∂q/∂{coordinate} is not `H_p`, p and q being independent",
        literal != h_p,
        f"`{literal}`",
    )
    operator = Check(
        f"by Eq. 5, `L_{{H_p}}`({coordinate}) = `H_p` ∂{coordinate}/∂q is not `H_p`",
        by_eq_5 != h_p,
        f"`{by_eq_5}`",
    )
    return _TEXTS.refutation(
        "eq_3",
        as_printed=as_printed,
        operator=operator,
        example=_example(),
        vanishes=vanishes("Eq. 4 from L¹ = 0", eq_4(flow, ring.zero)),
        holds_as_meant=_holds_as_meant(flow, "q"),
    )


def _holds_as_meant(flow: DifferentialFlow, coordinate: str) -> Check:
    diff = flow.ring.diff
    return vanishes(
        f"by Eq. 5, `L_{{H_p}}`({coordinate}) − `H_p` and `L_{{−H_q}}`(p) + `H_q`",
        flow.h_p * diff(flow.ring[coordinate], "q") - flow.h_p,
        -flow.h_q * diff(flow.ring["p"], "p") + flow.h_q,
    )


def _example() -> Check:
    """Check that the printed sides are 0 and 1, for H = p²/2 + q²/2 at (q, p) = (0, 1)."""
    # (q, p) = (0, 1): H_p = p is 1 there, and ∂q/∂p is 0.
    point = {symbol("p"): sympy.Integer(1), symbol("q"): sympy.Integer(0)}
    energy = P**2 / 2 + Q**2 / 2
    left = (sympy.diff(energy, P) * sympy.diff(Q, P)).subs(point)
    right = sympy.diff(energy, P).subs(point)
    return Check(
        "H = (p² + q²)/2 at (p, q) = (1, 0): `H_p` ∂q/∂p against `H_p`",
        left != right,
        f"{left} against {right}",
    )


def eq_3_meant(coordinate: str = "q") -> Argument:
    """Prove Eq. 3 with q for p in its first line: L_{H_p}(q) = H_p, L_{−H_q}(p) = −H_q."""
    hamiltonians = [with_symbols(name) for name in SYSTEMS]
    return _TEXTS.proof(
        "eq_3_meant",
        holds_as_meant=_holds_as_meant(flow_of_every_hamiltonian(2), coordinate),
        same=[
            _same(name, hamiltonian, 2)
            for name, hamiltonian in zip(SYSTEMS, hamiltonians, strict=True)
        ],
    )
