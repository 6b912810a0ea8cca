"""Eq. 12 as a product of the Jacobian and the state, and “near-identity” from ΔJ → 0."""

from collections.abc import Sequence
from fractions import Fraction

from verify.arithmetic.exact import decimal, text
from verify.claims.theorems.argument import Argument, Check, concluded, vanishes
from verify.claims.theorems.differential import flow_of_every_hamiltonian
from verify.claims.theorems.exact_maps import Point, areas, jacobian, map_from_formulas, next_point
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes.methods.taylor.lie import lie_map
from verify.schemes.step_map import StepMap
from verify.verdict import Verdict

H = Fraction(1, 10)
POINT = Point(p=Fraction(0), q=Fraction(1))


def eq_12(hamiltonian: Hamiltonian | None = None, point: Point = POINT) -> Argument:
    """z_{k+1} = J_k z_k: refuted at one rational point, of the Duffing oscillator if not told."""
    chosen = hamiltonian or systems.get("duffing").hamiltonian().with_values({"delta": 1})
    step = lie_map(chosen, 2)
    product, image = _product(step, point), next_point(step, point, H)
    linear = lie_map(Hamiltonian.parse("a*p**2/2 + b*p*q + c*q**2/2"), 2)
    checks = [
        Check(
            f"Duffing, δ = 1, lie2, h = {text(H)}, z = (p, q) = {point}: J z against z'",
            product != image,
            f"{product} against {image}",
        ),
        Check(
            "H = a p²/2 + b pq + c q²/2, lie2: J z = z' for all p, q, h, a, b, c",
            _is_linear(linear),
            "holds exactly" if _is_linear(linear) else "does not hold",
        ),
    ]
    return concluded(
        "eq-12",
        Verdict.REFUTED,
        f"for the Duffing oscillator (δ = 1, h = {text(H)}) at (p, q) = {point}, J z = {product} "
        "but "
        f"z' = {image}; it holds for all h only where H is quadratic",
        """By Euler's theorem on homogeneous functions J(z) z = Φ(z) for all z means that Φ is
        homogeneous of degree 1: d/ds [Φ(sz)/s] = [J(sz) sz − Φ(sz)]/s² = 0. If it holds for all
        small h on a disc around the origin, then the coefficient of h in Φ(z) = z + hf(z) + …, f =
        (−`H_q`, `H_p`), is homogeneous of degree 1 too; being differentiable at the origin it is
        linear, f(z) = lim f(sz)/s = f'(0) z, and H is a quadratic form plus a constant. Conversely,
        for such an H every Xⁿ z is linear and Eq. 12 is an identity. So for every other H that is
        smooth around the origin, the Duffing oscillator with δ ≠ 0 and the pendulum among them, Eq.
        12 is false as a product of a matrix and a vector. What holds is its tangent form,
        `δz_{k+1}` = `J_k` `δz_k` for infinitesimal differences, and that is all that Eq. 13–16 use:
        they need det `J_k` only. ∎""",
        checks,
    )


def _product(step: StepMap, point: Point) -> Point:
    a, b, c, d = jacobian(step, point, H)
    return Point(a * point.p + b * point.q, c * point.p + d * point.q)


def _is_linear(step: StepMap) -> bool:
    """Whether J z − z' is zero in the ring."""
    flat = step.flat
    ring = flat.ring
    a, b, c, d = flat.jacobian
    p, q = ring.variable("p"), ring.variable("q")
    gaps: Sequence = (a * p + b * q - flat.p_next, c * p + d * q - flat.q_next)  # type: ignore[type-arg]
    return all(ring.decide(x).zero is True for x in gaps)


def eq_12_tangent(stray: Fraction = Fraction(0)) -> Argument:
    """δz_{k+1} = J_k δz_k: Φ(z + sv) − Φ(z) − s J v is O(s²); `stray` is added to J's entries."""
    step = lie_map(systems.get("duffing").hamiltonian().with_values({"delta": 1}), 2)
    along = [Point(Fraction(1), Fraction(0)), Point(Fraction(0), Fraction(1))]
    sizes = [Fraction(1, 10**n) for n in (1, 2, 3)]
    gaps = [[_gap(step, v, s, stray) / s**2 for s in sizes] for v in along]
    bounded = all(max(row) <= 2 * min(row) for row in gaps if max(row))
    shown = "; ".join(", ".join(f"`{decimal(x, 3)}`" for x in row) for row in gaps)
    return concluded(
        "eq-12-tangent",
        Verdict.PROVED,
        "`δz_{k+1}` = `J_k` `δz_k` for infinitesimal differences is what a Jacobian matrix is, for "
        "every scheme that is differentiable; Eq. 13–16 use no more",
        """That Φ is differentiable at `z_k` says Φ(`z_k` + δz) = Φ(`z_k`) + `J_k` δz + o(|δz|), and
        for a Φ with second derivatives the rest is O(|δz|²). Every lieη of a smooth H is such a
        map. The next sentence of the paper calls `J_k` a tool for representing local linear
        transformations, and all that follows is made of det `J_k`; nothing needs Eq. 12 as a
        product of `J_k` and `z_k` itself. ∎""",
        [
            Check(
                f"Duffing, δ = 1, lie2, h = {text(H)}, (p, q) = {POINT}: |Φ(z + sv) − Φ(z) − s J v|"
                f"/s² for s = {', '.join(map(text, sizes))} and v along p; along q, is bounded",
                bounded,
                shown,
            )
        ],
    )


def _gap(step: StepMap, v: Point, s: Fraction, stray: Fraction) -> Fraction:
    a, b, c, d = (x + stray for x in jacobian(step, POINT, H))
    moved = next_point(step, Point(POINT.p + s * v.p, POINT.q + s * v.q), H)
    image = next_point(step, POINT, H)
    gap_p = moved.p - image.p - s * (a * v.p + b * v.q)
    return abs(gap_p) + abs(moved.q - image.q - s * (c * v.p + d * v.q))


def near_identity(start: int = 0) -> Argument:
    """Φ and J of lieη tend to the identity; `start`: the power of h from which on terms count."""
    flow = flow_of_every_hamiltonian(4)
    ring, at_0 = flow.ring, [flow.ring.zero, flow.ring.zero]
    for i, image in enumerate(flow.lie(3)):
        at_0[i] = ring.powers(image, "h").get(start, ring.zero)
    return concluded(
        "near-identity",
        Verdict.PROVED,
        "by Eq. 2 the step is z + h f(z) + O(h²), which tends to z as h → 0, and its Jacobian to "
        "the unit matrix, uniformly on compact sets",
        """Eq. 2 is Φ(z) = z + Σ hⁿ/n! Xⁿz, n = 1 … η, a polynomial in h whose term without h is z.
        For a smooth H its coefficients and their derivatives are bounded on compact sets, so Φ → id
        and J → 1 uniformly there. It follows that ΔJ → 0, too. ∎""",
        [
            vanishes(
                "p' and q' of lie3 without h are p and q, for a generic H",
                at_0[0] - ring["p"],
                at_0[1] - ring["q"],
            )
        ],
    )


def near_identity_inference(p_next: str = "-q", q_next: str = "p") -> Argument:
    """ΔJ → 0 does not make a near-identity map: a map with ΔJ = 0 that moves a point by 1."""
    step = map_from_formulas(p_next, q_next)
    sizes = (Fraction(1, 10), Fraction(1, 1000))
    delta_j = [areas(step, POINT, h, 4).largest for h in sizes]
    moved = [next_point(step, POINT, h) for h in sizes]
    far = [abs(z.p - POINT.p) + abs(z.q - POINT.q) for z in moved]
    checks = [
        Check(
            f"p' = `{p_next}`, q' = `{q_next}`: the largest |ΔJ| for h = 0.1 and 0.001",
            all(x == 0 for x in delta_j),
            ", ".join(map(text, delta_j)),
        ),
        Check(
            f"the same map takes (p, q) = {POINT} to a point that does not tend to it",
            all(x >= 1 for x in far),
            ", ".join(map(str, moved)),
        ),
    ]
    return concluded(
        "near-identity-inference",
        Verdict.REFUTED,
        f"ΔJ → 0 alone does not give it: p' = `{p_next}`, q' = `{q_next}` has ΔJ ≡ 0 for all h and "
        "is not near the identity; the scheme is near-identity because Eq. 2 is z + O(h)",
        """A determinant near 1 says that areas are nearly kept, not that points are nearly kept:
        the rotation by a right angle, p' = −q, q' = p, has det J = 1 for every h and moves (0, 1)
        to (−1, 0). The conclusion is true of lieη for another reason: by Eq. 2 Φ(z) = z + hf(z) +
        O(h²), which tends to z as h → 0, uniformly on compact sets, and J to the unit matrix. From
        that ΔJ → 0 follows, and not the other way round. ∎""",
        checks,
    )


THEOREMS = {
    "eq-12": eq_12,
    "eq-12-tangent": eq_12_tangent,
    "near-identity": near_identity,
    "near-identity-inference": near_identity_inference,
}
