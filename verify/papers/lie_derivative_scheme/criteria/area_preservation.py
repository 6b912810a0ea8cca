"""The definition of area preservation, and Criterion 1: det J, regions, and maps of the plane."""

from collections.abc import Sequence
from fractions import Fraction

import sympy

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.symbols import H_STEP, P, Q
from verify.arithmetic.exact import text
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.papers.argument import Argument, ArgumentTexts, Check, same
from verify.papers.exact_maps import map_from_texts
from verify.papers.lie_derivative_scheme import families
from verify.papers.lie_derivative_scheme.examples import duffing_step
from verify.schemes.maps.step_map import StepMap
from verify.schemes.methods.taylor.lie import lie_map

_TEXTS = ArgumentTexts(__file__)

_H = Fraction(1, 10)
TRIANGULAR = "p**3/6 + q"  # det J = 1, and the step has an inverse in closed form
FOLDED = ("(p**2 - q**2)/sqrt(2*(p**2 + q**2))", "2*p*q/sqrt(2*(p**2 + q**2))")


def image_area(step_map: StepMap) -> sympy.Expr:
    """Return the area of the image of the unit square at h = 1/10, as ∮ p' dq' along its edge.

    It is signed, and counts points as often as they are covered; the map must be polynomial.
    """
    s = sympy.Symbol("s", real=True)
    p_next, q_next = (
        x.subs(H_STEP, sympy.Rational(1, 10)) for x in (step_map.p_next, step_map.q_next)
    )
    sides = [((s, 0), 1), ((1, s), 1), ((s, 1), -1), ((0, s), -1)]  # p, q; and which way round
    # Green's theorem; the factor `orientation` makes the edge run counter-clockwise around.
    total = sympy.Integer(0)
    for (p, q), orientation in sides:
        x, y = (image.subs({P: p, Q: q}, simultaneous=True) for image in (p_next, q_next))
        total += orientation * sympy.integrate(sympy.expand(x * sympy.diff(y, s)), (s, 0, 1))
    return total


def integral_of_det(step_map: StepMap) -> sympy.Expr:
    """Return the integral of 1 + ΔJ over the unit square at h = 1/10."""
    det = 1 + sympy.expand(step_map.delta_j.subs(H_STEP, sympy.Rational(1, 10)))
    return sympy.integrate(det, (P, 0, 1), (Q, 0, 1))


def _areas_agree(name: str, step_map: StepMap, preserved: bool) -> Check:
    # Both numbers are computed independently: one along the edge, one over the interior.
    outline_area, integral = image_area(step_map), integral_of_det(step_map)
    return Check(
        f"{name}, h = {text(_H)}: the area of the unit square’s image, by its outline, and the "
        f"integral of det J over the square; {'both' if preserved else 'they agree, and are not'} "
        "1",
        outline_area == integral and (outline_area == 1) is preserved,
        f"`{outline_area}` and `{integral}`",
    )


def _check_regions(formula: str = TRIANGULAR) -> list[Check]:
    return [
        _areas_agree(f"lie2, H = `{formula}`", lie_map(Hamiltonian.parse(formula), 2), True),
        _areas_agree("lie2, Duffing, δ = 1", duffing_step(), False),
    ]


# -- the definition of Section 3 -------------------------------------------------------------------


def area_definition(formula: str = TRIANGULAR) -> Argument:
    """Prove that area preservation, the same area for each region's image, is decided by det J."""
    return _TEXTS.proof("area_definition", check_regions=_check_regions(formula))


def area_definition_flow(factor: int = 2) -> Argument:
    """Refute that area is preserved if and only if the flow is unchanged by the map."""
    c, s = sympy.symbols("c s", real=True)
    turn = sympy.Matrix([[c, -s], [s, c]])  # the oscillator's flow, c² + s² = 1
    scaling, shear = sympy.eye(2) * factor, sympy.Matrix([[1, 0], [1, 1]])
    commutator = shear * turn - turn * shear
    scales = Check(
        f"z ↦ {factor}z commutes with every turn of the plane, and its determinant is not 1",
        scaling * turn == turn * scaling and scaling.det() != 1,
        f"determinant {scaling.det()}",
    )
    shears = Check(
        "the shear has determinant 1, and what it differs by from commuting with a turn",
        shear.det() == 1 and commutator != sympy.zeros(2, 2),
        f"`{commutator[0, 0]}`, `{commutator[0, 1]}`, `{commutator[1, 0]}`, `{commutator[1, 1]}`",
    )
    return _TEXTS.refutation(
        "area_definition_flow",
        scales=scales,
        shears=shears,
        factor=str(factor),
        square=str(factor**2),
    )


# -- Criterion 1 -----------------------------------------------------------------------------------


def criterion_1(formula: str = TRIANGULAR) -> Argument:
    """Prove that det J = 1 gives equal areas, for regions on which the step is one-to-one."""
    return _TEXTS.proof(
        "criterion_1",
        check_regions=_check_regions(formula),
        moves_by_a_constant=families.moves_by_a_constant(),
        inverse=_inverse(lie_map(Hamiltonian.parse(formula), 2)),
        exact_flow=families.exact_flow(),
    )


def _inverse(step_map: StepMap) -> Check:
    """Check the inverse of lie2 for p³/6 + q: p = p' + h, from which q follows."""
    p_next, q_next = step_map.p_next, step_map.q_next
    back_p = P + H_STEP
    back_q = Q - (q_next - Q).subs(P, back_p)
    images_of_inverse = [
        x.subs({P: back_p, Q: back_q}, simultaneous=True) for x in (p_next, q_next)
    ]
    holds = [sympy.expand(x - y) == 0 for x, y in zip(images_of_inverse, (P, Q), strict=True)]
    return Check(
        f"lie2, H = `{TRIANGULAR}`: p = p' + h and the q that follows are its inverse, for all h",
        all(holds),
        f"p = `{to_text(back_p)}`, q = `{to_text(sympy.expand(back_q))}` of p' and q'",
    )


def criterion_1_any_map(formulas: Sequence[str] = FOLDED) -> Argument:
    """Refute it for any map, by (r, θ) ↦ (r/√2, 2θ): det J = 1, but an annulus's area halves."""
    step_map = map_from_texts(*formulas)
    r = sympy.sqrt(sympy.expand(step_map.p_next**2 + step_map.q_next**2))
    radius = sympy.simplify(r**2 / (P**2 + Q**2))
    opposite = [
        sympy.simplify(x.subs({P: -P, Q: -Q}, simultaneous=True) - x)
        for x in (step_map.p_next, step_map.q_next)
    ]
    preserves = same(
        f"p' = `{formulas[0]}`, q' = `{formulas[1]}`: ΔJ is the zero function",
        [step_map.delta_j],
        ("p", "q", "h"),
        "`0`",
    )
    covers = Check(
        "z and −z have the same image, and r'² = r²/2",
        opposite == [0, 0] and radius == sympy.Rational(1, 2),
        f"r'²/r² = `{radius}`",
    )
    before, after = (sympy.pi * (4 - 1) * share for share in (1, radius))
    halves = Check(
        "the areas π(4 − 1) of 1 ≤ r ≤ 2, and π(4 − 1) r'²/r² of its image",
        before == 2 * after,
        f"`{before}` and `{after}`",
    )
    return _TEXTS.refutation(
        "criterion_1_any_map", preserves=preserves, covers=covers, halves=halves
    )
