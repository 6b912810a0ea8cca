"""The mixed kernel: its float64 lines have the bits of the real kernel, compiled by LLVM."""

import math
import re
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from verify import arithmetic
from verify.arithmetic.compiled.doubles import one_point
from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import Kernel, KernelWriter
from verify.kernels.stepping import KernelRun
from verify.lockstep import run_alone
from verify.schemes import get
from verify.studies.separation.determinants import POINTS, WORKING, Determinants
from verify.studies.separation.mixed_kernel import mixed_kernel
from verify.studies.separation.mixed_run import MixedRun, marks_of
from verify.studies.separation.way import MixedKernel

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
PENDULUM = Hamiltonian.parse("p**2/2 - cos(q)")
SYSTEMS = {
    "duffing-lie2": (DUFFING, "lie2", 8000),
    "duffing-lie4": (DUFFING, "lie4", 1500),
    "pendulum-lie2": (PENDULUM, "lie2", 8000),
    "pendulum-symplectic-euler": (PENDULUM, "symplectic-euler", 4000),
    "hyperbolic": (Hamiltonian.parse("p**2/2 + cosh(q) + exp(q/2)"), "symplectic-euler", 2000),
    "roots": (Hamiltonian.parse("p**2/2 + (1 + q**2 + p**2)**(1/3)"), "lie2", 500),
    "functions": (Hamiltonian.parse("exp(p/3) + log(2 + q**2) + atan(p*q) + sqrt(1 + q**2)"),
                  "lie2", 500),
}  # fmt: skip


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["mpfr", "fixed"])
@pytest.mark.parametrize(("hamiltonian", "scheme", "steps"), SYSTEMS.values(), ids=SYSTEMS)
def test_states_and_products_have_the_bits_of_the_compiled_float64_kernel(
    hamiltonian: Hamiltonian, scheme: str, steps: int, name: str
) -> None:
    if name == "fixed" and hamiltonian in (SYSTEMS["roots"][0], SYSTEMS["functions"][0]):
        pytest.skip("fixed has neither these roots nor atan")
    start = {"p": Fraction(1, 3), "q": Fraction(3, 2), "h": Fraction(1, 1000)}
    found = states(hamiltonian, scheme, start, steps, name)
    compiled = by_llvm(hamiltonian, scheme)
    inputs = [float(x) for x in (start["h"], *dict(hamiltonian.values).values())]
    for mark in range(steps // 10, steps + 1, steps // 10):
        begun = [float(start["p"]), float(start["q"]), *map(float, compiled.start)]
        _, *after = compiled.function(mark, *inputs, *begun)
        point, at = dict(zip(compiled.state_names, after, strict=True)), found[mark]
        assert (at["f_p"], at["f_q"], at["f_plain"]) == (point["p"], point["q"], point["plain"])


def by_llvm(hamiltonian: Hamiltonian, scheme: str) -> Kernel:
    """The float64 kernel of `verify run`, by the compiler that long runs have it from."""
    made = replace(arithmetic.get("float64", 17), compile=float64._compile_now)
    step_map = get(scheme).step_map(hamiltonian.with_symbols())
    return KernelWriter(step_map, made, WORKING, compensated=False).kernel()


def mixed(hamiltonian: Hamiltonian, scheme: str, follow: bool = True) -> MixedKernel:
    return mixed_kernel(
        Determinants(), hamiltonian.with_symbols(), scheme, arithmetic.get("mpfr", 40), follow
    )


def states(
    hamiltonian: Hamiltonian, scheme: str, start: dict[str, Fraction], steps: int, name: str
) -> dict[int, dict[str, Any]]:
    """What the mixed kernel carries, by the number of steps."""
    run = KernelRun(hamiltonian, scheme, start, steps, WORKING, 10)
    made = arithmetic.get(name, 50)
    working = MixedRun(Determinants(), run, follow=False)
    found = run_alone(working.step_all(made, lambda _: None)).states
    return dict(zip(marks_of(steps, POINTS), found, strict=True))


def test_compiled_functions_have_the_bits_of_pythons() -> None:
    """So that the float64 lines may run in either."""
    points = [k / 997 + 2.0 ** -(k % 30) for k in range(1, 20000)]
    for name in ("sin", "cos", "exp", "log", "sinh", "cosh", "atan", "log1p", "sqrt"):
        function = getattr(math, name)
        loop = f"    for k in range(steps):\n        x = {name}(x)\n    return steps, x\n"
        compiled = one_point(f"def g(steps, x):\n{loop}", {})
        assert [compiled(1, x)[1] for x in points] == [function(x) for x in points], name


@pytest.mark.parametrize(("hamiltonian", "scheme", "steps"), SYSTEMS.values(), ids=SYSTEMS)
def test_names_say_of_every_line_whether_it_is_float64_or_wide(
    hamiltonian: Hamiltonian, scheme: str, steps: int
) -> None:
    lines = mixed(hamiltonian, scheme).source.strip().splitlines()
    for line in lines[1:-1]:
        names = set(re.findall(r"[A-Za-z_]\w*(?!\w*\()", line)) - {"for", "k", "in", "if", "steps"}
        kinds = {name[:2] for name in names}
        assert kinds <= {"f_", "w_"}, line
        assert len(kinds) < 2 or "wide(" in line, "kinds do not mix"
        for called in re.findall(r"(\w+)\(", line):
            if called not in ("wide", "abs", "range"):
                assert called.startswith("f_") == (kinds == {"f_"}), line
