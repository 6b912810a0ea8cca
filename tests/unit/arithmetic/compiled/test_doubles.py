"""float64 kernels by LLVM: Python's bits, and what they do not know is left to Python."""

import math
from fractions import Fraction
from typing import Any

import pytest

from verify.arithmetic.compiled import doubles
from verify.arithmetic.number_system import interpret
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.systems import get
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.stepping import KernelRun

_OWN = float64.compiled_at_once()


def chain(scheme: str, n: int) -> tuple[Kernel, list[Any]]:
    hamiltonian = get("fput").hamiltonian({"n": n, "alpha": "1/4", "beta": "1/2"})
    point = dict.fromkeys(hamiltonian.coordinates, Fraction(1, 7)) | {"q1": Fraction(1, 10)}
    start = {**point, "h": Fraction(1, 100), "t": Fraction(0)}
    run = KernelRun(hamiltonian, scheme, start, 100, frozenset(), 0)
    kernel = kernel_for(run.hamiltonian, scheme, _OWN, frozenset())
    return kernel, [float(x) for x in (*run.inputs(kernel, 0).values(), *point.values())]


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2", "rk4"])
def test_a_long_kernel_has_the_bits_of_python(scheme: str) -> None:
    kernel, given = chain(scheme, 4)
    ours = doubles.one_point(kernel.source, kernel.names)
    in_python = interpret(kernel.source, "kernel", kernel.names)
    assert ours(100, *given) == tuple(in_python(100, *given))
    assert doubles.prepared_call(ours, 100, *given)() is None
    assert doubles.prepared_call(in_python, 1, *given)()[0] == 1  # type: ignore[index]
    assert ours(0, *given) == (0, *given[-8:])


PLANE = {
    "polynomial": "p**2/2 + q**2/2 + q**4/4",
    "sine": "p**2/2 - cos(q)",
    "functions": "p**2/2 + exp(q) - q + sinh(q)**2 + atan(q)",
    "not separable": "(p**2 + 1)*(q**2 + 1)/2",
}


@pytest.mark.left_to_ci
@pytest.mark.sample(4)
@pytest.mark.parametrize("text", PLANE.values(), ids=PLANE)
@pytest.mark.parametrize("scheme", ["lie2", "implicit-midpoint", "gauss4"])
def test_a_kernel_of_the_plane_has_the_bits_of_python(scheme: str, text: str) -> None:
    """Loops in the loop too, which solve equations."""
    hamiltonian = Hamiltonian.parse(text)
    asked = frozenset({"lambda", "lambda_plain", "lambda_max", "mse"})
    kernel = kernel_for(hamiltonian, scheme, _OWN, asked)
    start = [0.05, 0.3, 0.7, *map(float, kernel.start)]
    in_python = interpret(kernel.source, "kernel", kernel.names)
    assert doubles.one_point(kernel.source, kernel.names)(300, *start) == in_python(300, *start)


LOOP = "def kernel(steps, x):\n    for k in range(steps):\n        x = {0}\n    return steps, x\n"


@pytest.mark.parametrize("n", [2, 3, 5, 10])
def test_roots_have_the_bits_of_python(n: int) -> None:
    root = doubles.one_point(LOOP.format(f"root(x, {n})"), {})
    for x in (*(1.7**k / 3 for k in range(-300, 300)), 0.0, -0.0, 5e-324, 1e308):
        found = root(1, x)[1]
        assert (found, math.copysign(1, found)) == (
            float64._root(x, n), math.copysign(1, float64._root(x, n)),
        )  # fmt: skip
    assert all(math.isnan(root(1, x)[1]) for x in (-1.0, -math.inf, math.nan))


def test_what_is_not_in_the_language_is_left_to_python() -> None:
    source = LOOP.format("expm1(x)")
    with pytest.raises(NotImplementedError):
        doubles.one_point(source, {})
    in_python = float64._compile_now(source, "kernel", {"expm1": math.expm1})
    assert in_python(2, 0.5) == (2, math.expm1(math.expm1(0.5)))
    for text in ("0.5 / y + x", "1 / (y + y) + x"):
        at = float64._compile_now(f"def f(x, y):\n    return {text}\n", "f", {})
        assert [at(3.0, 2.0), at(-1.0, -0.0)] == [3.25, -math.inf]
    summed = "def f(x):\n    for k in range(1, 3):\n        x = x + k\n    return x\n"
    assert float64._compile_now(summed, "f", {})(0.5) == 3.5


def test_lanes_that_would_part_are_left_to_one_point_after_another() -> None:
    kernel = kernel_for(Hamiltonian.parse(PLANE["sine"]), "gauss4", _OWN, frozenset())
    with pytest.raises(NotImplementedError):
        doubles.on_points(kernel.source, kernel.names, 2)


@pytest.mark.sample(2)
@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2", "rk4", "lie4"])
def test_a_step_of_a_chain_has_as_many_operations_a_mass_however_long_it_is(scheme: str) -> None:
    small, middle, large = (len(chain(scheme, n)[0].program.ops) for n in (4, 6, 8))
    assert large - middle == middle - small > 0
