"""Eq. 12 as a product of the Jacobian and the state, and “near-identity” from ΔJ → 0."""

from fractions import Fraction

import sympy

from verify.algebra.symbols import P, Q
from verify.arithmetic.exact import decimal, text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers import differential_polynomials
from verify.papers.argument import NUMBERS, Argument, ArgumentTexts, Check, same, vanishes
from verify.papers.exact_maps import RationalPoint, areas, jacobian, map_from_texts, next_point
from verify.papers.lie_derivative_scheme.examples import duffing, duffing_step
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

H = Fraction(1, 10)
POINT = RationalPoint(p=Fraction(0), q=Fraction(1))


def eq_12(hamiltonian: Hamiltonian | None = None, point: RationalPoint = POINT) -> Argument:
    """Refute z_{k+1} = J_k z_k at one rational point, by default for the Duffing oscillator."""
    step_map = lie_map(hamiltonian or duffing(), 2)
    product, image = _product(step_map, point), next_point(step_map, point, H)
    at_a_point = Check(
        f"Duffing, δ = 1, lie2, h = {text(H)}, z = (p, q) = {point}: J z against z'",
        product != image,
        f"{product} against {image}",
        NUMBERS,
    )
    return _TEXTS.refutation(
        "eq_12",
        at_a_point=at_a_point,
        euler=euler(),
        stays_linear=stays_linear(),
        check_quadratic_form=_check_quadratic_form(),
        h=text(H),
        point=str(point),
        product=str(product),
        image=str(image),
    )


def _product(step_map: StepMap, point: RationalPoint) -> RationalPoint:
    a, b, c, d = jacobian(step_map, point, H)
    return RationalPoint(a * point.p + b * point.q, c * point.p + d * point.q)


def _check_quadratic_form() -> Check:
    step_map = lie_map(Hamiltonian.parse("a*p**2/2 + b*p*q + c*q**2/2"), 2)
    gaps = step_map.jacobian * sympy.Matrix([P, Q]) - sympy.Matrix(
        [step_map.p_next, step_map.q_next]
    )
    statement = "H = a p²/2 + b pq + c q²/2, lie2: J z = z' for all p, q, h, a, b, c"
    return same(statement, list(gaps), ("p", "q", "h", "a", "b", "c"), "holds exactly")


def eq_12_tangent(stray: Fraction = Fraction(0)) -> Argument:
    """Prove δz_{k+1} = J_k δz_k: Φ(z + sv) − Φ(z) − s J v = O(s²); `stray` is added to J."""
    step_map = duffing_step()
    directions = [RationalPoint(Fraction(1), Fraction(0)), RationalPoint(Fraction(0), Fraction(1))]
    sizes = [Fraction(1, 10**n) for n in (1, 2, 3)]
    gaps = [[_gap(step_map, v, s, stray) / s**2 for s in sizes] for v in directions]
    # The quotients stay bounded as s falls by powers of ten if the remainder is O(s²).
    bounded = all(max(row) <= 2 * min(row) for row in gaps if max(row))
    texts = "; ".join(", ".join(f"`{decimal(x, 3)}`" for x in row) for row in gaps)
    example = Check(
        f"Duffing, δ = 1, lie2, h = {text(H)}, (p, q) = {POINT}: |Φ(z + sv) − Φ(z) − s J v|"
        f"/s² for s = {', '.join(map(text, sizes))} and v along p; along q, is bounded",
        bounded,
        texts,
        NUMBERS,
    )
    return _TEXTS.proof("eq_12_tangent", example=example)


def _gap(step_map: StepMap, v: RationalPoint, s: Fraction, stray: Fraction) -> Fraction:
    a, b, c, d = (x + stray for x in jacobian(step_map, POINT, H))
    moved_image = next_point(step_map, RationalPoint(POINT.p + s * v.p, POINT.q + s * v.q), H)
    image = next_point(step_map, POINT, H)
    # The 1-norm: any norm of the plane will do, and this one keeps rational numbers rational.
    gap_p = moved_image.p - image.p - s * (a * v.p + b * v.q)
    return abs(gap_p) + abs(moved_image.q - image.q - s * (c * v.p + d * v.q))


def near_identity(start: int = 0) -> Argument:
    """Prove that Φ and J of lieη tend to the identity; `start`: the least power of h counted."""
    flow = differential_polynomials.flow_of_every_hamiltonian(4)
    ring, at_0 = flow.ring, [flow.ring.zero, flow.ring.zero]
    for i, image in enumerate(flow.lie(3)):
        at_0[i] = ring.powers(image, "h").get(start, ring.zero)
    without_h = vanishes(
        "p' and q' of lie3 without h are p and q, for a generic H",
        at_0[0] - ring["p"],
        at_0[1] - ring["q"],
    )
    return _TEXTS.proof("near_identity", without_h=without_h)


def near_identity_inference(p_next: str = "-q", q_next: str = "p") -> Argument:
    """Refute that ΔJ → 0 makes a near-identity map, by one with ΔJ = 0 that moves a point by 1."""
    step_map = map_from_texts(p_next, q_next)
    sizes = (Fraction(1, 10), Fraction(1, 1000))
    delta_j = [areas(step_map, POINT, h, 4).largest for h in sizes]
    images = [next_point(step_map, POINT, h) for h in sizes]
    # A distance of at least 1 for every h excludes any limit z + O(h).
    distances = [abs(z.p - POINT.p) + abs(z.q - POINT.q) for z in images]
    for_every_h = same(
        f"p' = `{p_next}`, q' = `{q_next}`: ΔJ is the zero function",
        [step_map.delta_j],
        ("p", "q", "h"),
    )
    along_a_run = Check(
        "the same map: the largest |ΔJ| along 4 steps for h = 0.1 and 0.001",
        all(x == 0 for x in delta_j),
        ", ".join(map(text, delta_j)),
        NUMBERS,
    )
    moves = Check(
        f"the same map takes (p, q) = {POINT} to a point that does not tend to it",
        all(x >= 1 for x in distances),
        ", ".join(map(str, images)),
        NUMBERS,
    )
    return _TEXTS.refutation(
        "near_identity_inference",
        for_every_h=for_every_h,
        along_a_run=along_a_run,
        moves=moves,
        p_next=p_next,
        q_next=q_next,
    )


def euler(power: int = 2) -> Check:
    """Check d/ds [Φ(sz)/s] = [J(sz) sz − Φ(sz)]/s² for a generic Φ; `power` stands for the 2."""
    names = ["u", "s", "F", "F_p", "F_q", "p", "q"]
    ring = differential_polynomials.Differential(names)
    u, s, f, f_p, f_q, p, q = (ring[name] for name in names)
    # u = 1/s is a variable with a relation, as the ring has no negative powers.
    ring.relate(u * s - 1)  # u = 1/s
    ring.set_gradient("s", s=ring.context.constant(1))
    ring.set_gradient("u", s=-u * u)
    ring.set_gradient("F", s=f_p * p + f_q * q)
    right = (f_p * s * p + f_q * s * q - f) * u**power
    return vanishes(
        "d/ds [Φ(sz)/s] − [J(sz) sz − Φ(sz)]/s² for a component of a generic Φ",
        ring.reduce(ring.diff(f * u, "s") - right),
    )


def stays_linear(bent: int = 0) -> Check:
    """Check that X y is linear if y is, for a quadratic form H; `bent` p² is added to y."""
    names = ["p", "q", "a", "b", "c", "alpha", "beta"]
    ring = differential_polynomials.Differential(names)
    p, q, a, b, c, alpha, beta = (ring[name] for name in names)
    ring.set_coordinates()
    flow = differential_polynomials.DifferentialFlow(ring, a * p + b * q, b * p + c * q)
    # f = (−H_q, H_p) is linear for a quadratic H, and a derivative along it keeps the degree.
    derivative = flow.derive(alpha * p + beta * q + bent * p * p)
    linear = (a * beta - b * alpha) * p + (b * beta - c * alpha) * q
    return vanishes(
        "X(αp + βq) − (aβ − bα)p − (bβ − cα)q for H = a p²/2 + b pq + c q²/2", derivative - linear
    )
