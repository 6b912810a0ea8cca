"""Bounds hold on orbits of every shape, of every quantity, in every number system, both ways.

An orbit is drawn by a seed, which stands in the test's name: `tests.helpers.sampled.shapes` has its
values without the toolkit.
"""

import random
from fractions import Fraction

import pytest

from tests.helpers.sampled.shapes import DIGITS, SHAPES, Shape, mp, number, values
from verify.arithmetic.exact import of_mpf
from verify.arithmetic.number_system import Arithmetic, UnsupportedError
from verify.arithmetic.systems import fixed, mpfr, mpmath
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.runs.a_posteriori_bound import certify
from verify.runs.estimates import resolve
from verify.runs.requested_run import run

SEEDS = range(12)
SLACK = Fraction(1, 10**70)  # of the values that are compared with, in parts of their size
PLANE = frozenset({"delta_j_max", "mse", "lambda", "lambda_max"})
SEVERAL = PLANE - {"lambda_max"} | {"symplectic_defect_max", "symplectic_defect"}


def drawn(name: str, seed: int) -> tuple[Shape, dict[str, Fraction], random.Random]:
    draw = random.Random(f"{name} {seed}")  # noqa: S311 - no secret
    shape = SHAPES[name](draw)
    return shape, values(shape), draw


def started(shape: Shape) -> KernelRun:
    start = {**dict(shape.start), "h": shape.h, "t": shape.t0}
    hamiltonian = Hamiltonian.parse(shape.formula)
    if not hamiltonian.time_dependent:
        del start["t"]
    asked = PLANE if hamiltonian.planar else SEVERAL
    return KernelRun(hamiltonian, f"lie{shape.order}", start, shape.steps, asked, 0)


def assert_within(
    found: dict[str, Fraction], bounds: dict[str, Fraction], true: dict[str, Fraction]
) -> None:
    for name, bound in bounds.items():
        off, slack = abs(found[name] - true[name]), SLACK * (1 + abs(true[name]))
        assert off <= bound + slack, f"{name}: {float(off / bound) if bound else off} of its bound"


def systems(draw: random.Random) -> list[Arithmetic]:
    bits = draw.choice([12, 20, 33, 64, 120])
    return [fixed.at_bits(112), mpfr.at_bits(bits), mpmath.at_bits(bits + 3)]


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", SHAPES)
def test_what_is_certified_or_estimated_holds_the_true_value(name: str, seed: int) -> None:
    shape, true, draw = drawn(name, seed)
    kernel_run = started(shape)
    certificates = 0
    for arithmetic in systems(draw):
        try:
            outcome = kernel_run.run(arithmetic, tangent=True)
        except UnsupportedError:
            continue
        if outcome.done < shape.steps:  # it left the format
            continue
        found = {n: Fraction(x) for n, x in outcome.values.items()}
        certified = certify(kernel_run, arithmetic, outcome)
        if certified is not None:
            certificates += len(certified)
            assert_within(found, certified, true)
        if arithmetic.bits < 30:
            continue  # an estimate asks for runs that have some digits
        estimated = run_alone(resolve(kernel_run, arithmetic, outcome, 5))
        if estimated.status == "finished":
            pairs = estimated.values.items()
            assert_within({n: x for n, (x, _) in pairs}, {n: y for n, (_, y) in pairs}, true)
    # Of some shapes there is no certificate at few bits, or from a step that is too large; where
    # there was none at all the test would say nothing.
    assert certificates or name in ("increments", "one step", "small denominators")


@pytest.mark.left_to_ci
@pytest.mark.sample(5)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", SHAPES)
def test_what_a_run_tells_holds_the_true_value(name: str, seed: int) -> None:
    """As a user asks, of each number system by its name."""
    shape, true, _ = drawn(name, seed)
    hamiltonian, start = Hamiltonian.parse(shape.formula), dict(shape.start)
    n = len(start) // 2
    place = {letter: [start[x] for x in shape.names if x[0] == letter] for letter in "pq"}
    given = {x: y if n > 1 else y[0] for x, y in place.items()}
    asked = tuple(sorted(PLANE if n == 1 else SEVERAL))
    for system in ("fixed", "mpfr", "mpmath", "ball", "float64"):
        try:
            told = run(hamiltonian, f"lie{shape.order}", **given, step_size=shape.h,
                       steps=shape.steps, t0=shape.t0, arithmetic=system, digits=20,
                       observables=asked)  # fmt: skip
        except InputError:
            assert system == "float64", "of the others each takes all of these"
            continue
        assert told.status == "finished" or system == "float64", system
        values_of = {name: Fraction(x.value) for name, x in told.values.items()}
        # A value is printed with the digits that are known: half a unit of its last one beside.
        bounds = {name: Fraction(x.bound) for name, x in told.values.items()}
        assert_within(values_of, bounds, true)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("seed", range(3))
def test_a_million_steps_of_a_linear_map_are_within_their_bounds(seed: int) -> None:
    """lie2 of H = p²/2 + c q²/2, a matrix of which the power is had by squaring."""
    draw = random.Random(f"million {seed}")  # noqa: S311 - no secret
    c, h, steps = Fraction(draw.randint(1, 9), 10), Fraction(1, draw.choice([64, 256])), 10**6
    text = f"p**2/2 + {c}*q**2/2"
    start = {"p": Fraction(draw.randint(-9, 9), 7), "q": Fraction(5, 3), "h": h}
    kernel_run = KernelRun(Hamiltonian.parse(text), "lie2", start, steps, PLANE, 0)
    arithmetic = fixed.at_bits(176)
    outcome = kernel_run.run(arithmetic, tangent=True)
    certified = certify(kernel_run, arithmetic, outcome)
    assert certified is not None
    assert {"p", "q", "lambda", "mse"} <= set(certified)
    true = values_of_linear(c, h, steps, start)
    found = {n: Fraction(outcome.values[n]) for n in true}
    assert_within(found, {n: certified[n] for n in true}, true)


def values_of_linear(
    c: Fraction, h: Fraction, steps: int, start: dict[str, Fraction]
) -> dict[str, Fraction]:
    """By powers of the matrix in mpmath's numbers, of which 120 digits lose a dozen."""
    with mp.workdps(DIGITS):
        return _values_of_linear(c, h, steps, start)


def _values_of_linear(
    c: Fraction, h: Fraction, steps: int, start: dict[str, Fraction]
) -> dict[str, Fraction]:
    a, b = 1 - c * h**2 / 2, h
    matrix = mp.matrix([[number(a), number(-c * b)], [number(b), number(a)]])
    power = matrix**steps
    p, q = number(start["p"]), number(start["q"])
    determinant = number(a * a + c * b * b)
    change = determinant - 1
    return {
        "p": of_mpf(power[0, 0] * p + power[0, 1] * q),
        "q": of_mpf(power[1, 0] * p + power[1, 1] * q),
        "lambda": of_mpf(determinant**steps - 1),
        "mse": of_mpf(change**2),
        "delta_j_max": of_mpf(abs(change)),
    }
