"""Bounds of a step's derivatives are, over a box of one point, what sympy's derivatives are there;
and over a box they hold them all."""

import random
from fractions import Fraction
from functools import cache
from itertools import combinations
from typing import Any

import flint
import pytest
import sympy

from verify.arithmetic.arb import rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.step_bounds import StepDerivatives

PLANE = [("p**2*(1 + q**2)/2 + q**4/4 + p*q", 2), ("p**2/2 + q**3 + p**3*q/5", 1)]
SEVERAL = [("(p1**2 + p2**2)/2 + q1**2*q2 + p1*q2**2/3", 2),
           ("(p1**2 + p2**2 + p3**2)/2 + q1*q2*q3 + p3*q1**2/5", 1)]  # fmt: skip
H = sympy.Symbol("h")


@cache
def derived(formula: str, order: int) -> dict[str, Any]:
    """lieη by sympy: z', its second derivatives, det J − 1, S, and gradients."""
    names = sorted(map(str, sympy.sympify(formula).free_symbols))
    symbols = [sympy.Symbol(n) for n in names]
    n = len(symbols) // 2
    energy = sympy.sympify(formula)
    slopes = [*(-energy.diff(q) for q in symbols[n:]), *(energy.diff(p) for p in symbols[:n])]
    after, term = list(symbols), list(symbols)
    for k in range(1, order + 1):
        term = [sum(x.diff(z) * f for z, f in zip(symbols, slopes, strict=True)) for x in term]
        after = [x + H**k * y / sympy.factorial(k) for x, y in zip(after, term, strict=True)]
    jacobian = sympy.Matrix(after).jacobian(symbols)
    zero, unit = sympy.zeros(n), sympy.eye(n)
    omega = sympy.Matrix(sympy.BlockMatrix([[zero, unit], [-unit, zero]]))
    defect = (jacobian.T * omega * jacobian - omega).applyfunc(sympy.expand)
    above = [defect[a, b] for a, b in combinations(range(2 * n), 2)]
    change = sympy.expand(jacobian.det() - 1)
    return {
        "names": names,
        "second": [x.diff(a).diff(b) for x in after for a in symbols for b in symbols],
        "gradient": [change.diff(z) for z in symbols],
        "size": [*above, *above],
        "slope": [x.diff(z) for x in (*above, *above) for z in symbols],
    }


def norm_of(found: dict[str, Any], what: str, at: dict[str, Fraction], h: Fraction) -> float:
    put = {sympy.Symbol(n): sympy.Rational(x) for n, x in at.items()} | {H: sympy.Rational(h)}
    return float(sum(float(x.subs(put)) ** 2 for x in found[what]) ** 0.5)


def bounds_of(formula: str, order: int, box: dict[str, flint.arb], h: Fraction) -> dict[str, float]:
    hamiltonian, scheme = Hamiltonian.parse(formula), f"lie{order}"
    with working_precision(96):
        fixed = {"h": rational_ball(h)}
        made: Any
        if hamiltonian.planar:
            made = StepDerivatives.from_scheme(hamiltonian, scheme, volume=True, form=False)
            form = ()
        else:
            made = StepDerivatives.from_scheme(hamiltonian, scheme, volume=True, form=True)
            form = made.form(fixed, box)
        found = {"second": made.second(fixed, box), "gradient": made.gradient(fixed, box)}
        found |= dict(zip(("size", "slope"), form, strict=False))
        return {name: float(x.upper()) for name, x in found.items()}


@pytest.mark.left_to_ci
@pytest.mark.parametrize(("formula", "order"), [*PLANE, *SEVERAL])
def test_at_a_point_they_are_those_of_sympy(formula: str, order: int) -> None:
    found, draw = derived(formula, order), random.Random(formula)  # noqa: S311 - no secret
    for _ in range(4):
        at = {n: Fraction(draw.randint(-20, 20), 7) for n in found["names"]}
        h = Fraction(draw.randint(1, 9), 20)
        box = {n: rational_ball(x) for n, x in at.items()}
        for name, bound in bounds_of(formula, order, box, h).items():
            true = norm_of(found, name, at, h)
            if name == "gradient" and "1" not in found["names"][0]:
                # In the plane it is summed by powers of h: no less, and no more than their sum.
                assert true * (1 - 1e-12) <= bound <= 4 * true + 1e-12, name
            else:
                assert bound == pytest.approx(true, rel=1e-9), name


@pytest.mark.parametrize(("formula", "order"), [*PLANE, *SEVERAL])
def test_over_a_box_they_hold_what_is_anywhere_in_it(formula: str, order: int) -> None:
    found, draw = derived(formula, order), random.Random(f"box {formula}")  # noqa: S311 - no secret
    middle = {n: Fraction(draw.randint(-20, 20), 15) for n in found["names"]}
    width, h = Fraction(1, 5), Fraction(1, 10)
    box = {n: rational_ball(x - width).union(rational_ball(x + width)) for n, x in middle.items()}
    bounds = bounds_of(formula, order, box, h)
    for _ in range(12):
        at = {n: x + width * draw.randint(-8, 8) / 8 for n, x in middle.items()}
        for name, bound in bounds.items():
            assert norm_of(found, name, at, h) <= bound * (1 + 1e-12), name
