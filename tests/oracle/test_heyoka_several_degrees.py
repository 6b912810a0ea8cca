"""lieη in several degrees of freedom, and S = JᵀΩJ − Ω: those of heyoka's Taylor integrator.

Held to one order and one step as in `by_heyoka`; in the widest number type but heyoka's own that
there is. Needs the extra `oracle`; without heyoka this is skipped.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import chain, combinations
from typing import Any

import pytest

from tests.oracle.by_heyoka import PRECISIONS, STEP_SIZE, Precision, hy
from verify.algebra.enclosure import enclose
from verify.arithmetic.arb import midpoint_and_radius
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order_for_one_h import prove
from verify.schemes import get

WIDEST = PRECISIONS.get("quad") or PRECISIONS.get("extended") or PRECISIONS["double"]
TIME = Fraction(3, 8)
POINT = [Fraction(n, 16) for n in (5, -7, 9, 6, -3, 11)]


@dataclass(frozen=True)
class System:
    """H for us and for heyoka, of p1 …, q1 … and t."""

    formula: str
    theirs: Callable[..., Any]


SYSTEMS = {
    "cubic": System(  # as Hénon–Heiles, with no third, which heyoka rounds
        "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/4",
        lambda p, q, r, s, t: (p**2 + q**2 + r**2 + s**2) / 2 + r**2 * s - s**3 / 4,
    ),
    "kepler": System(
        "(p1**2 + p2**2)/2 - 1/sqrt(q1**2 + q2**2)",
        lambda p, q, r, s, t: (p**2 + q**2) / 2 - 1 / hy.sqrt(r**2 + s**2),
    ),
    "not separable": System(
        "(p1*q2 + p2)**2/2 + q1*q2*exp(p1/2)",
        lambda p, q, r, s, t: (p * s + q) ** 2 / 2 + r * s * hy.exp(p / 2),
    ),
    "driven": System(
        "(p1**2 + p2**2)/2 + q1**2*q2 - q1*cos(t)",
        lambda p, q, r, s, t: (p**2 + q**2) / 2 + r**2 * s - r * hy.cos(t),
    ),
}
every_case = pytest.mark.parametrize(
    ("name", "eta"), [(name, eta) for name in SYSTEMS for eta in (2, 3, 4)]
)


@cache
def theirs(name: str, eta: int) -> tuple[list[Fraction], list[list[Fraction]]]:
    """z' and J by one step of heyoka's from the point, at the time."""
    precision: Precision = WIDEST
    variables = hy.make_vars("p1", "p2", "q1", "q2")
    h, number = SYSTEMS[name].theirs(*variables, hy.time), precision.number
    slopes = [*(-hy.diff(h, x) for x in variables[2:]), *(hy.diff(h, x) for x in variables[:2])]
    equations = list(zip(variables, slopes, strict=True))
    taylor = hy.taylor_adaptive(
        hy.var_ode_sys(equations, hy.var_args.vars, order=1),
        [number(float(x)) for x in POINT[:4]],
        time=number(float(TIME)),
        tol=number(math.exp(3 - 2 * eta)),
        fp_type=precision.type,
    )
    assert taylor.order == eta
    outcome, _ = taylor.step(max_delta_t=number(float(STEP_SIZE)))
    assert outcome == hy.taylor_outcome.time_limit
    state = [precision.rational(x) for x in taylor.state]
    # z', then each component's derivatives by all of z
    return state[:4], [state[4 + 4 * i : 8 + 4 * i] for i in range(4)]


@cache
def ours(name: str, eta: int) -> tuple[list[Fraction], list[list[Fraction]]]:
    """The same of the map that is proved, enclosed to within 2^−200."""
    made = get(f"lie{eta}").step_map(Hamiltonian.parse(SYSTEMS[name].formula))
    assert made.closed is not None
    at = {**dict(zip(made.field.names, POINT, strict=False)), "h": STEP_SIZE, "t": TIME}

    def value(x: Any) -> Fraction:
        middle, radius = midpoint_and_radius(enclose(made.ring, x, at, 300))
        assert radius < Fraction(1, 2**200)
        return middle

    rows = [[value(y) for y in made.field.gradient(x)] for x in made.closed.elements]
    return [value(x) for x in made.closed.elements], rows


def defect(rows: list[list[Fraction]]) -> dict[tuple[int, int], Fraction]:
    """JᵀΩJ − Ω above its diagonal."""
    return {
        (a, b): sum(rows[i][a] * rows[2 + i][b] - rows[2 + i][a] * rows[i][b] for i in (0, 1))
        - (b == a + 2)
        for a, b in combinations(range(4), 2)
    }  # type: ignore[misc]


@every_case
def test_the_step_and_its_jacobian_are_heyokas(name: str, eta: int) -> None:
    (z, rows), (z0, rows0) = ours(name, eta), theirs(name, eta)
    for x, y in zip(chain(z, *rows), chain(z0, *rows0), strict=True):
        assert abs(x - y) <= 4 * WIDEST.rounding(x)


@every_case
def test_and_so_is_the_symplectic_defect_which_has_the_order_that_is_proved(
    name: str, eta: int
) -> None:
    mine, other = (defect(found(name, eta)[1]) for found in (ours, theirs))
    allowed = 64 * WIDEST.rounding(max(abs(x) for row in ours(name, eta)[1] for x in row) ** 2)
    assert all(abs(mine[at] - other[at]) <= allowed for at in mine)
    scheme = get(f"lie{eta}")
    proof = prove(scheme.step_map(Hamiltonian.parse(SYSTEMS[name].formula)), scheme)
    assert proof.order == eta + 1
    largest = max(abs(x) for x in other.values())
    assert largest > 1000 * allowed, "it is seen above heyoka's rounding"
    scale = STEP_SIZE**proof.order
    at = {**dict(zip(proof.first.form.names, POINT, strict=False)), "t": TIME}  # type: ignore[union-attr]
    for (a, b), x in other.items():
        leading = proof.first.form.entry(a, b)  # type: ignore[union-attr]
        ball = enclose(proof.first.form.ring, leading, at, 100)  # type: ignore[union-attr, arg-type]
        expected = midpoint_and_radius(ball)[0]
        assert abs(x / scale - expected) < Fraction(1, 4) * (largest / scale)


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_neighbouring_order_is_told_apart(name: str) -> None:
    """The negative control."""
    (_, rows), (_, others) = ours(name, 3), theirs(name, 2)
    apart = max(abs(x - y) for x, y in zip(chain(*rows), chain(*others), strict=True))
    assert apart > 100 * WIDEST.rounding(Fraction(1))
