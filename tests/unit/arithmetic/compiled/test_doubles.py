"""Long float64 kernels by LLVM alone: numba's bits, and what they do not know is left to it."""

from fractions import Fraction
from typing import Any

import pytest

from verify.arithmetic.compiled import doubles
from verify.arithmetic.systems import float64
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


@pytest.mark.sample(2)
@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2", "rk4"])
def test_a_long_kernel_has_the_bits_of_numba(scheme: str) -> None:
    kernel, given = chain(scheme, 6)
    ours = doubles.one_point(kernel.source, kernel.names)
    by_numba = float64._by_numba(kernel.source, "kernel", kernel.names)
    assert ours(100, *given) == tuple(by_numba(100, *given))
    assert doubles.prepared_call(ours, 100, *given)() is None
    assert doubles.prepared_call(by_numba, 1, *given)()[0] == 1  # type: ignore[index]
    assert ours(0, *given) == (0, *given[-12:])


def test_long_ones_are_so_compiled_and_short_ones_not(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    monkeypatch.setattr(doubles, "one_point", lambda source, _: made.append(source))
    long, short = ("def kernel(steps):\n    for k in range(steps):\n" + "        x = 1\n" * n
                   for n in (float64._LONG, 3))  # fmt: skip
    for source in (short, long):
        float64._compiled(source + "    return steps, steps\n", "kernel", {})
    assert [len(source) for source in made] == [len(long) + len("    return steps, steps\n")]


def test_a_function_that_is_not_in_the_language_is_left_to_numba() -> None:
    lines = "        x = x + root(x, 3)\n" * float64._LONG
    source = f"def kernel(steps, x):\n    for k in range(steps):\n{lines}    return steps, x\n"
    with pytest.raises(NotImplementedError):
        doubles.one_point(source, {})


@pytest.mark.parametrize("scheme", ["stormer-verlet", "lie2", "rk4", "lie4"])
def test_a_step_of_a_chain_has_as_many_operations_a_mass_however_long_it_is(scheme: str) -> None:
    small, middle, large = (len(chain(scheme, n)[0].program.ops) for n in (4, 6, 8))
    assert large - middle == middle - small > 0
