"""The tangent map that a kernel carries, followed step by step with exact numbers beside it.

M_k is `m` with its rest, both float64. What the certificate takes for granted is checked at every
step: M_{k+1} = A_k M_k + R_k with ‖R_k‖ ≤ ρ ‖M_k‖, where A_k is the exact Jacobian at the computed
state, and that the sums, extremes and the box are those of the M_k and the states.
"""

from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise
from typing import Any

import flint
import pytest

from tests.helpers.exact_orbits import case, jacobian
from verify.arithmetic.arb import bounds, rational_ball
from verify.arithmetic.flint_precision import working_precision
from verify.arithmetic.number_system import Arithmetic
from verify.arithmetic.systems import fixed, mpfr, mpmath
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ChunkedLoop
from verify.kernels.kernel import kernel_for
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.matrix_growth import square_of_norm
from verify.runs.step_bounds import StepRounding

ORBITS = {
    "duffing-lie2": case("p**2/2 + q**2/2 + 7*q**4/12", "lie2", "3/2", "1/3", "1/70", 60),
    "pendulum-lie3": case("p**2/2 - cos(q)", "lie3", "3/2", "3/2", "1/10", 60),
    "euler": case("p**2/2 - cos(q)", "symplectic-euler", "3/2", "1/2", "1/3", 60),
    "saddle": case("p**2/2 + cos(q)", "lie2", "1/1000", 0, "1/5", 60),
    "shrinking": case("p", "p_next = p*3/4 + q**2/9; q_next = q*2/3 + h*p", 1, 1, "1/7", 60),
    "large-steps": case("p", "p_next = 5.1*p + 6.9*q; q_next = 2*p + 3*q", "0.1", "0.1", 1, 3),
}
Matrix = list[Fraction]


def states(kernel_run: KernelRun, arithmetic: Arithmetic) -> Iterator[dict[str, Fraction]]:
    """The carried numbers before the first step, and after each."""
    made = (
        kernel_run.hamiltonian,
        kernel_run.scheme,
        arithmetic,
        kernel_run.observables | {"tangent"},
    )
    kernel = kernel_for(*made)
    shift, limits = next(kernel_run.formats(kernel, arithmetic)) if arithmetic.absolute else (0, ())
    walk = ChunkedLoop(kernel_run, kernel, arithmetic, limits[: len(kernel.limits)], shift)
    for step in range(kernel_run.steps + 1):
        if step:
            (after,) = run_alone(walk._advance(1))
            walk.state, walk.done = after, step
            walk._note()
        yield {n: walk._exact(x) for n, x in zip(kernel.state_names, walk.state, strict=True)}


def matrix(at: dict[str, Fraction]) -> Matrix:
    return [at[f"m_{entry}"] + at[f"m_{entry}_rest"] for entry in ("pp", "pq", "qp", "qq")]


def product(x: list[Any], y: Matrix) -> list[Any]:
    return [x[2 * i] * y[j] + x[2 * i + 1] * y[2 + j] for i in (0, 1) for j in (0, 1)]


def squares(x: Matrix) -> Fraction:
    return sum((entry * entry for entry in x), Fraction(0))


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("arithmetic", [fixed.at_bits(112), mpfr.at_bits(70), mpmath.at_bits(30)],
                         ids=lambda a: a.name)  # fmt: skip
@pytest.mark.parametrize("name", ORBITS)
def test_the_tangent_map_is_as_near_as_is_counted_and_its_sums_are_its_own(
    name: str, arithmetic: Arithmetic
) -> None:
    orbit = ORBITS[name]
    kernel_run = orbit.kernel_run()
    seen, determinants, sizes, visited, products = [], [], [], [], [Fraction(0)]
    for at in states(kernel_run, arithmetic):
        seen.append((at, matrix(at)))
        sizes.append(squares(matrix(at)))
        a, b, c, d = matrix(at)
        determinants.append(a * d - b * c)
        visited.append((at["p"], at["q"]))
        products.append(at["part" if arithmetic.absolute else "lam"])
    counted = rho(kernel_run, arithmetic)
    worst = Fraction(0)
    for (before, m), (_, after) in pairwise(seen):
        with working_precision(300):
            near = product(jacobian(orbit, before["p"], before["q"]), [rational_ball(x) for x in m])
            apart = [bounds(abs(x - rational_ball(y)))[1] for x, y in zip(near, after, strict=True)]
        assert squares(apart) <= counted**2 * squares(m)
        worst = max(worst, squares(apart) / squares(m))
    assert counted**2 <= 10**6 * worst, "nor is it absurdly large"

    last = seen[-1][0]
    assert near_float(last["growth"], sum(sizes), len(sizes))
    assert near_float(last["growth_top"], max(sizes), 1)
    assert abs(last["det_low"] - min(determinants)) <= max(sizes) / 2**50
    for k, n in enumerate("pq"):
        values = [Fraction(float(kernel_run.start[n])), *(state[k] for state in visited[:-1])]
        assert abs(last[f"{n}_low"] - min(values)) <= (1 + max(map(abs, values))) / 2**51
        assert abs(last[f"{n}_high"] - max(values)) <= (1 + max(map(abs, values))) / 2**51
    assert (last["least"], last["most"]) == (min(products), max(products))


def rho(kernel_run: KernelRun, arithmetic: Arithmetic) -> Fraction:
    """ρ for the whole run."""
    run = kernel_run.run(arithmetic, tangent=True)
    with working_precision(96):
        steps = StepRounding(kernel_run, arithmetic, run, len(run.trail) - 1).errors()
        assert steps is not None
        return bounds(steps.tangent)[1]


def near_float(x: Fraction, true: Fraction, additions: int) -> bool:
    return abs(x - true) <= true * additions / 2**51


@pytest.mark.parametrize("name", ORBITS)
def test_a_norm_is_bounded_by_the_sum_of_squares_and_the_determinant(name: str) -> None:
    """The square of the norm, of each matrix and of their mean; equal where the determinant is."""
    all_of = [matrix(at) for at in states(ORBITS[name].kernel_run(), mpfr.at_bits(70))]
    with working_precision(200):
        balls = [[rational_ball(x) for x in m] for m in all_of]
        determinants = [a * d - b * c for a, b, c, d in balls]
        sums = [rational_ball(squares(m)) for m in all_of]
        least = rational_ball(min(bounds(d)[0] for d in determinants))
        norms = [greatest_eigenvalue(m) for m in balls]
        for norm, total, own in zip(norms, sums, determinants, strict=True):
            assert not square_of_norm(2, total, least) < norm
            exact = square_of_norm(2, total, own)
            assert exact - norm < exact * flint.arb(2) ** -60
        mean = sum(norms, flint.arb(0)) / len(norms)
        assert not square_of_norm(2, sum(sums, flint.arb(0)) / len(sums), least) < mean


def greatest_eigenvalue(m: list[Any]) -> Any:
    """Of MᵀM, by its characteristic polynomial."""
    a, b, c, d = m
    x, y, z = a * a + c * c, b * b + d * d, a * b + c * d
    return (x + y + ((x - y) ** 2 + 4 * z * z).sqrt()) / 2


@pytest.mark.parametrize("t0", ["-1/2", "0", "1/3", "40"])
@pytest.mark.parametrize("arithmetic", [fixed.at_bits(112), mpfr.at_bits(70), mpmath.at_bits(60)],
                         ids=lambda a: a.name)  # fmt: skip
@pytest.mark.parametrize("degrees", [1, 2])
def test_in_time_it_is_the_product_of_the_steps_from_whatever_t(
    degrees: int, arithmetic: Arithmetic, t0: str
) -> None:
    """Explicit Euler of H = p²/2 + (1 + t) q²/20, whose Jacobian is known at every step; a second
    degree is p₂²/2, of which M has the entries 1, 1 and k h."""
    text = "p**2/2 + (1 + t)*q**2/20"
    names = ("p", "q")
    if degrees == 2:
        text, names = f"{text.replace('p', 'p1').replace('q', 'q1')} + p2**2/2", ("p1", "q1")
    h, steps = Fraction(1, 50), 40
    start = {n: Fraction(1, 7) for n in ("p1", "p2", "q1", "q2")[: 2 * degrees]}
    start = start if degrees == 2 else dict.fromkeys(names, Fraction(1, 7))
    start |= {"h": h, "t": Fraction(t0)}
    made = KernelRun(Hamiltonian.parse(text), "lie1", start, steps, frozenset(), 0)
    seen = made.run(arithmetic, tangent=True).tangents[-1]

    m, sizes, determinants = [Fraction(x) for x in (1, 0, 0, 1)], [], []
    for k in range(steps + 1):
        beside = [Fraction(x) for x in (1, 1, k * h)] if degrees == 2 else []
        sizes.append(squares(m) + squares(beside))
        determinants.append(m[0] * m[3] - m[1] * m[2])
        force = (1 + Fraction(t0) + k * h) / 10
        m = product([Fraction(1), -h * force, h, Fraction(1)], m)
    assert near_float(seen["growth_top"], max(sizes), 8)
    assert near_float(seen["growth"], sum(sizes), steps + 8)
    assert abs(seen["det_low"] - min(determinants)) <= max(sizes) / 2**48
