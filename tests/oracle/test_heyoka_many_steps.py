"""Hundreds of steps: z_N, Λ, MSE and max |ΔJ| of our runs are those of heyoka's tangent map.

heyoka carries M_k = ∂z_k/∂z_0 along, so that Λ = det M_N − 1 and ΔJ_k = det M_(k+1)/det M_k − 1:
no closed form, no product of ours. See `by_heyoka` for how it is held, and how far one of its
steps may be off. In what follows from that for N steps, to first order:

- z_N: step k's rounding e_k arrives as M_N M_k⁻¹ e_k, and M_k is at hand;
- det M_N: the sum of what each step's rounding does to det M_k, since det J_k ≈ 1;
- ΔJ_k: what one step's rounding does to det M_(k+1), over det M_k.

SLACK is for the second order and for ΔJ_k at a z_k that is off: both are thousands of times less.
A run's own bound, which it reports, is added.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from tests.oracle.by_heyoka import (
    PRECISIONS,
    STEP_SIZE,
    SYSTEMS,
    Precision,
    State,
    defect,
    oracle,
)
from verify import arithmetic
from verify.runs.requested_run import run
from verify.scenes.results.run import RunResult

STEPS = 300
START = (Fraction(1, 4), Fraction(5, 4))
SLACK = Fraction(11, 10)
VALUES = ("p", "q", "lambda", "mse", "delta_j_max")
ETAS = (2, 3, 4)
LONG = [x for x in PRECISIONS.values() if x.name != "mpfr"]
every_case = pytest.mark.parametrize(
    ("name", "precision", "eta"),
    [
        pytest.param(name, precision, eta, id=f"{name}-{precision.name}-lie{eta}")
        for name, system in SYSTEMS.items()
        for precision in LONG
        for eta in ETAS
        if eta <= system.highest // 2  # a run costs more than the map at a few points
    ],
)


@dataclass(frozen=True, repr=False)  # the fractions have thousands of digits
class Theirs:
    values: dict[str, Fraction]
    bounds: dict[str, Fraction]


@cache
def theirs(name: str, precision: Precision, eta: int) -> Theirs:
    chosen = oracle(name, precision, eta)
    chosen.start(START)
    states: list[State] = [[*START, *map(Fraction, (1, 0, 0, 1))]]
    states += [chosen.step() for _ in range(STEPS)]
    areas = [1 + defect(state)[0, 1] for state in states]
    defects = [after / before - 1 for before, after in pairwise(areas)]
    bounds = [precision.defect_bounds(state)[0, 1] for state in states[1:]]
    off = [SLACK * bound / area for bound, area in zip(bounds, areas, strict=False)]
    orbit = _orbit_bound(precision, states)
    return Theirs(
        values={
            "p": states[-1][0],
            "q": states[-1][1],
            "lambda": areas[-1] - 1,
            "mse": sum(x * x for x in defects) / STEPS,
            "delta_j_max": max(map(abs, defects)),
        },
        bounds={
            "p": orbit,
            "q": orbit,
            "lambda": SLACK * sum(off),
            "mse": sum(b * (2 * abs(x) + b) for x, b in zip(defects, off, strict=True)) / STEPS,
            "delta_j_max": max(off),
        },
    )


def _orbit_bound(precision: Precision, states: list[State]) -> Fraction:
    """Σ ‖M_N M_k⁻¹‖ e_k over k = 1 … N, in the maximum norm."""
    maps = [np.array(state[2:], dtype=float).reshape(2, 2) for state in states]
    total = 0.0
    for state, tangent in zip(states[1:], maps[1:], strict=True):
        size = float(max(map(precision.rounding, state[:2])))
        total += size * np.linalg.norm(maps[-1] @ np.linalg.inv(tangent), np.inf)
    assert math.isfinite(total)
    return SLACK * Fraction(total)


@cache
def ours(name: str, eta: int, chosen: str) -> RunResult:
    p, q = START
    return run(
        SYSTEMS[name].hamiltonian, f"lie{eta}", q=q, p=p, step_size=STEP_SIZE, steps=STEPS,
        arithmetic=chosen, digits=17 if chosen == "float64" else 50,
    )  # fmt: skip


def excess(found: RunResult, oracles: Theirs, value: str) -> float:
    """The difference in units of what the two bounds allow together."""
    own = found.values[value]
    allowed = oracles.bounds[value] + Fraction(own.bound)
    return float(abs(Fraction(own.value) - oracles.values[value]) / allowed)


@every_case
def test_a_run_is_the_orbit_of_heyoka_with_its_area(
    name: str, precision: Precision, eta: int
) -> None:
    found, oracles = ours(name, eta, "mpfr"), theirs(name, precision, eta)
    for value in VALUES:
        assert excess(found, oracles, value) <= 1, value
    assert abs(oracles.values["lambda"]) > 50 * oracles.bounds["lambda"], "Λ = 0 would pass"


@every_case
def test_a_run_of_a_neighbouring_order_is_far_off(
    name: str, precision: Precision, eta: int
) -> None:
    for other in (eta - 1, eta + 1):
        found, oracles = ours(name, other, "mpfr"), theirs(name, precision, eta)
        for value in VALUES:
            assert excess(found, oracles, value) > 50, (other, value)


@pytest.mark.skipif("quad" not in PRECISIONS, reason="this heyoka has no real128")
@pytest.mark.parametrize("chosen", arithmetic.names())
@pytest.mark.parametrize("name", SYSTEMS)
def test_every_arithmetic_agrees_within_its_own_bound(name: str, chosen: str) -> None:
    found, oracles = ours(name, 2, chosen), theirs(name, PRECISIONS["quad"], 2)
    for value in VALUES:
        assert excess(found, oracles, value) <= 1, value
