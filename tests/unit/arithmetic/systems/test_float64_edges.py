"""float64 in Python where Python refuses: the bits of the compiled kernel, and nothing compiled.

Orbits leave the range in few steps; the oracle is LLVM's kernel of the same source.
"""

import math
from itertools import product
from typing import Any

import pytest

from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, kernel_for
from verify.runs.requested_run import run

ASKED = frozenset({"lambda", "lambda_plain", "mse", "delta_j_max"})
FORMULAS = [
    "p**2/2 - 1/q",
    "p**2/2 + exp(q)",
    "cosh(p) + sinh(q)**2",
    "p**2/2 + log(q)",
    "p**2/2 - cos(q**3)",
    "sqrt(1 + p**3) + q**2",
    "p**2/2 + (1 + q)**(1/3)",
    "p**4*q**4 + p**3",
]
VALUES = (0.0, -0.0, 1.0, -1.0, 1e-200, 1e160, -1e300, 5e-324)


def kernels(formula: str, scheme: str) -> tuple[Kernel, Kernel]:
    """That of a short run, and the compiled one."""
    h = Hamiltonian.parse(formula)
    kernel_for.cache_clear()  # both arithmetics have one name and precision
    short = kernel_for(h, scheme, float64.make(17), ASKED)
    kernel_for.cache_clear()
    long = kernel_for(h, scheme, float64.compiled_at_once(), ASKED)
    kernel_for.cache_clear()
    return short, long


def same(x: Any, y: Any) -> bool:
    """The same bits, but for those of NaN."""
    if isinstance(x, float) and math.isnan(x):
        return math.isnan(y)
    return bool(x == y and math.copysign(1.0, x) == math.copysign(1.0, y))


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("formula", "scheme"),
    [*((text, "lie2") for text in FORMULAS), ("1/(q**2 + 1) - 4*p**5/3", "implicit-midpoint")],
)
def test_what_python_refuses_has_the_bits_of_the_compiled_kernel(
    formula: str, scheme: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    short, long = kernels(formula, scheme)
    starts = list(product(VALUES, VALUES))
    wanted = [long.function(3, 0.5, p, q, *map(float, long.start)) for p, q in starts]
    monkeypatch.setattr(float64, "_compile_now", None)  # not called
    for (p, q), expected in zip(starts, wanted, strict=True):
        found = short.function(3, 0.5, p, q, *map(float, short.start))
        assert all(map(same, found, expected)), (p, q, found, expected)
    assert any(not math.isfinite(x) for end in wanted for x in end), "none left the range"


def test_an_orbit_that_escapes_is_told_without_compiling(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(float64, "_compile_now", None)
    h = Hamiltonian.parse("p**2/2 - exp(q)")
    found = run(h, "lie2", q="10", p="3", step_size="5", steps=12)
    assert found.status == "left range"
