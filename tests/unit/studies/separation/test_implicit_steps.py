"""Truncation and rounding in W of steps that solve equations, against mpmath and rationals.

mpmath solves the equations by itself and takes derivatives by differences. It shares nothing with
the toolkit, which says at which float64 states a step is made, and what Jacobian float64 has there.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.stepping.lie2_separation import Matrix, identity, product, pulled_back
from tests.helpers.stepping.steps_by_differences import (
    Field,
    State,
    Step,
    along,
    implicit_midpoint,
    moved,
    mp,
)
from verify import arithmetic as number_systems
from verify.hamiltonians import systems
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.studies.separation.links import separate_chains
from verify.studies.separation.matrix_products import Matrices
from verify.studies.separation.mixed_run import MixedRun

HENON = systems.get("henon-heiles").hamiltonian({})
START = {"p1": "0.1", "p2": "0.2", "q1": "0.3", "q2": "-0.1", "h": "0.1"}
STEPS = 5


def henon_heiles(z: State) -> State:
    """f of H = Σ (p² + q²)/2 + q1² q2 − q2³/3."""
    p1, p2, x, y = z
    return [-x - 2 * x * y, -y - x * x + y * y, p1, p2]


def gauss4(f: Field, z: State, h: Any) -> State:
    root = mp.sqrt(3)
    rows = [[mp.mpf(1) / 4, mp.mpf(1) / 4 - root / 6], [mp.mpf(1) / 4 + root / 6, mp.mpf(1) / 4]]
    slopes = [f(z), f(z)]
    for _ in range(60):  # each time h smaller
        slopes = [f(moved(z, *((h * a, k) for a, k in zip(row, slopes, strict=True))))
                  for row in rows]  # fmt: skip
    return moved(z, *((h / 2, k) for k in slopes))


SCHEMES: dict[str, Step] = {"implicit-midpoint": implicit_midpoint, "gauss4": gauss4}


def exact_jacobian(step: Step, z: State, h: Any) -> Matrix:
    unit = [[mp.mpf(a == b) for b in range(4)] for a in range(4)]
    columns = [along(lambda y: step(henon_heiles, y, h), z, v) for v in unit]
    return [list(row) for row in zip(*columns, strict=True)]


def run_of(start: dict[str, Fraction], scheme: str, steps: int) -> list[Any]:
    """What is carried after each step."""
    run = MixedRun(Matrices(4), KernelRun(HENON, scheme, start, steps, frozenset(), 0), False)
    arithmetic = number_systems.get("mpfr", 40)
    return list(run_alone(run.step_all(arithmetic, lambda _: None)).states)


def states_and_jacobians(scheme: str) -> tuple[list[list[float]], list[Matrix]]:
    """float64's states, the first one too, and its Jacobians at all but the last of them."""
    point = {name: Fraction(float(Fraction(x))) for name, x in START.items()}
    states, jacobians = [[float(point[n]) for n in HENON.coordinates]], []
    for _ in range(STEPS):
        (after,) = run_of(point, scheme, 1)
        jacobians.append([[after[f"f_plain_{a}_{b}"] for b in range(4)] for a in range(4)])
        point |= {n: Fraction(after[f"f_{n}"]) for n in HENON.coordinates}
        states.append([after[f"f_{n}"] for n in HENON.coordinates])
    return states, jacobians


def apart(one: Sequence[Any], other: Sequence[Any]) -> Any:
    return max(abs(mp.mpf(a) - mp.mpf(b)) for a, b in zip(one, other, strict=True))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_steps_and_jacobians_that_are_multiplied_are_those_of_mpmath(scheme: str) -> None:
    states, jacobians = states_and_jacobians(scheme)
    step, h = SCHEMES[scheme], mp.mpf(0.1)
    for z, after, j in zip(states, states[1:], jacobians, strict=False):
        at = list(map(mp.mpf, z))
        assert apart(step(henon_heiles, at, h), after) < 1e-15
        rows = exact_jacobian(step, at, h)
        assert all(apart(a, b) < 1e-15 for a, b in zip(rows, j, strict=True))
        wrong = exact_jacobian(step, at, h * (1 + mp.mpf(10) ** -12))
        assert any(apart(a, b) > 1e-15 for a, b in zip(wrong, j, strict=True)), "it is seen"


@pytest.mark.parametrize("scheme", SCHEMES)
def test_derivatives_and_product_are_those_of_float64s_jacobians(scheme: str) -> None:
    """Multiplied as rationals, and in float64 from the left."""
    start = {name: Fraction(x) for name, x in START.items()}
    chains = run_alone(separate_chains(HENON, scheme, start, STEPS, 30))
    _, jacobians = states_and_jacobians(scheme)
    exact: Matrix = identity(4)
    for j in jacobians:
        exact = product([[Fraction(x) for x in row] for row in j], exact)
    links = pulled_back(exact)
    for chain, place in zip(chains.plain, links, strict=True):
        value, bound = chain.final("derivatives")
        assert abs(value - links[place]) <= bound <= abs(value) / 10**30
        assert chain.final("truncation") == chain.final("input") == (0, 0)
        assert chain.final("trajectory") == (0, 0)
        assert chain.final("total") == chain.final("lambda_working")
        assert sum(chain.final(n)[0] for n in chain.parts) == chain.final("lambda_working")[0]
    assert chains.closed_form is not None
    assert all(chain.final("lambda_working") == (0, 0) for chain in chains.closed_form)
