"""The Hamiltonians for which lie2 preserves area exactly: the identities of their classification.

Notation: w = ∇H = (H_p, H_q), D = det Hess H, N = −X²z, the negative of the acceleration z''. In
the plane N = adj(Hess H) w, and J = 1 + hA − (h²/2) N' with A = (−H_q, H_p)'.
"""

from verify.papers import differential_polynomials
from verify.papers.argument import Check, vanishes

LINEAR = ("a*p + b*q", "c*p + d*q")  # H = F(u) + rest
PARABOLIC = ("a*p + b*q + (c*p + d*q)**2/2", "0")
_CONSTANTS = ("a", "b", "c", "d")


def family(name: str, u: str, rest: str) -> Check:
    """Check that ΔJ of lie2 is zero for H = F(u) + rest, for a generic F and all constants."""
    flow = differential_polynomials.flow_of_one_function(_CONSTANTS, u, rest)
    return vanishes(f"ΔJ of lie2 for {name}, F generic", *flow.delta_j_gaps(2))


def linear() -> Check:
    """Check that ΔJ of lie2 is zero for H = F(ℓ) + m, ℓ and m linear."""
    return family("H = F(ap + bq) + cp + dq", *LINEAR)


def parabolic() -> Check:
    """Check that ΔJ of lie2 is zero for H = F(ℓ + m²/2), ℓ and m linear."""
    return family("H = F(ap + bq + (cp + dq)²/2)", *PARABOLIC)


def moves_by_a_constant(rest: str = LINEAR[1]) -> Check:
    """Check for H = F(ℓ) + m that X ℓ is a constant, and Xz, X²z functions of ℓ.

    ℓ and m are linear; `rest` stands for m.
    """
    flow = differential_polynomials.flow_of_one_function(_CONSTANTS, LINEAR[0], rest)
    names = (*_CONSTANTS, "p", "q", "F1", "F2")
    a, b, c, d, p, q, f1, f2 = (flow.ring[name] for name in names)
    # Xℓ for linear ℓ and m: the motion crosses the lines ℓ = constant at a constant speed.
    steady = b * c - a * d
    return vanishes(
        "H = F(ℓ) + cp + dq, ℓ = ap + bq, F generic: Xℓ − (bc − ad), Xp + bF' + d, Xq − aF' − c, "
        "X²p + bF''(bc − ad), X²q − aF''(bc − ad)",
        flow.derive(a * p + b * q) - steady,
        flow.derive(p) + b * f1 + d,
        flow.derive(q) - a * f1 - c,
        flow.derive(flow.derive(p)) + b * f2 * steady,
        flow.derive(flow.derive(q)) - a * f2 * steady,
    )


def exact_flow() -> Check:
    """Check that lie2 is the flow itself where X³z = 0."""
    # F needs one derivative more than for ΔJ, as X³ takes three.
    flow = differential_polynomials.flow_of_one_function(_CONSTANTS, *PARABOLIC, 5)
    third = [flow.lie_derivatives(z, 3)[3] for z in ("p", "q")]
    return vanishes("X³p and X³q for H = F(ap + bq + (cp + dq)²/2): lie2 is its exact flow", *third)


def separable() -> Check:
    """Check ΔJ of lie2 for H = T(p) + V(q), T and V generic; T1 stands for T', and so on."""
    names = [f"{f}{k}" for f in "TV" for k in range(1, 5)]
    ring = differential_polynomials.Differential(["h", "p", "q", *names])
    ring.set_coordinates()
    # T4 and V4 have no gradients: ΔJ of lie2 needs no derivatives beyond them.
    for k in range(1, 4):
        ring.set_gradient(f"T{k}", p=ring[f"T{k + 1}"], q=ring.zero)
        ring.set_gradient(f"V{k}", p=ring.zero, q=ring[f"V{k + 1}"])
    t1, t2, t3, v1, v2, v3 = (ring[f"{f}{k}"] for f in "TV" for k in (1, 2, 3))
    gaps = differential_polynomials.DifferentialFlow(ring, t1, v1).delta_j_gaps(
        2, h3=(t1 * t2 * v3 - v1 * v2 * t3) / 2, h4=(t2**2 * v2**2 - t1 * t3 * v1 * v3) / 4
    )
    return vanishes(
        "H = T(p) + V(q): ΔJ = (h³/2)(T'T''V''' − V'V''T''') + (h⁴/4)(T''²V''² − T'T'''V'V''')",
        *gaps,
    )


def equilibrium() -> Check:
    """Check that ΔJ of lie2 is h⁴D²/4 at a critical point of a generic H."""
    flow = differential_polynomials.flow_of_every_hamiltonian(4)
    # At an equilibrium the gradient of H vanishes, and the derivatives beyond it stay free.
    rest_point: dict[str | int, int] = {"H1_0": 0, "H0_1": 0}
    gaps = [x.subs(rest_point) for x in flow.delta_j_gaps(2, h4=flow.hessian_determinant**2 / 4)]
    return vanishes("ΔJ of lie2 where ∇H = 0 is h⁴D²/4, for a generic H", *gaps)


def coefficients() -> Check:
    """Check ΔJ = (h³/2) X D + (h⁴/4)(D² + det T) for a generic H.

    T_ij = Σ_k ∂_j adj(Hess H)_ik w_k, w = ∇H.
    """
    flow = differential_polynomials.flow_of_every_hamiltonian(4)
    ring, w = flow.ring, (flow.h_p, flow.h_q)
    pp, pq, qq = flow.hessian
    adjugate = ((qq, -pq), (-pq, pp))
    t = [
        [sum((ring.diff(row[k], z) * w[k] for k in (0, 1)), ring.zero) for z in ("p", "q")]
        for row in adjugate
    ]
    d = flow.hessian_determinant
    fourth = (d * d + t[0][0] * t[1][1] - t[0][1] * t[1][0]) / 4
    return vanishes(
        "ΔJ = (h³/2) X D + (h⁴/4) (D² + det T) for a generic H, and no other powers",
        *flow.delta_j_gaps(2, h3=flow.derive(d) / 2, h4=fourth),
    )


def acceleration() -> Check:
    """Check −X²z = adj(Hess H) ∇H, and div N = 2 D, for a generic H."""
    flow = differential_polynomials.flow_of_every_hamiltonian(4)
    pp, pq, qq = flow.hessian
    n_p, n_q = (-flow.lie_derivatives(z, 2)[2] for z in ("p", "q"))
    return vanishes(
        "−X²z = adj(Hess H) ∇H, and its divergence is 2 D, for a generic H",
        n_p - (qq * flow.h_p - pq * flow.h_q),
        n_q - (-pq * flow.h_p + pp * flow.h_q),
        flow.ring.diff(n_p, "p") + flow.ring.diff(n_q, "q") - 2 * flow.hessian_determinant,
    )


def by_acceleration(half: int = 4) -> Check:
    """Check that the coefficient of h⁴ in ΔJ is det N'/4, N = −X²z; `half` is that 4."""
    flow = differential_polynomials.flow_of_every_hamiltonian(4)
    ring = flow.ring
    n_p, n_q = (-flow.lie_derivatives(z, 2)[2] for z in ("p", "q"))
    return vanishes(
        "the coefficient of h⁴ in ΔJ of lie2 less det N'/4 for a generic H, N = −X²z",
        flow.delta_j_gaps(2, h4=ring.bracket(n_p, n_q) / half)[3],
    )


def twice(factor: int = 2) -> Check:
    """Check that λT'' = cT'² and T''' = cT'T'' give λT''' = 2T'''; `factor` is that 2."""
    ring = differential_polynomials.Differential(["p", "T1", "T2", "c", "lambda"])
    t1, t2, c, constant = (ring[name] for name in ring.names[1:])
    third = c * t1 * t2
    ring.set_gradient("T1", p=t2)
    ring.set_gradient("T2", p=third)
    derived = ring.diff(constant * t2 - c * t1 * t1, "p")
    return vanishes(
        "the derivative of λT'' − cT'² less (λ − 2) T''', where T''' = cT'T''",
        derived - (constant - factor) * third,
    )
