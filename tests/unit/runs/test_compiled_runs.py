"""The kernels that runs compile: names in them, memory, and how many there are."""

import subprocess
import sys
from functools import cache
from typing import Any

import pytest

from verify.arithmetic.systems import float64
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.requested_run import run
from verify.scenes.observables import REPORTED
from verify.scenes.results.run import RunResult

# -- names ----------------------------------------------------------------------------------------

# A kernel is text in which parameters stand beside its own names.
OWN_NAMES = [
    *(f"v{i}" for i in range(30)), "k", "dj", "lam", "mse", "top", "size", "plain", "steps", "add",
    "total", "part", "p_rest", "dj_low", "lam_high", "kernel", "range", "escape", "cos_sin", "root",
    "pq", "E", "I", "S", "N", "zoo", "beta", "True_", "self", "print",
]  # fmt: skip


def named(parameter: str, name: str) -> RunResult:
    text = f"p**2/2 + {parameter}*q**2/2 + q**4/4 - cos(q)"
    return run(Hamiltonian.parse(text, {parameter: "7/3"}), "lie2", q=1, p=0, step_size="0.1",
               steps=20, arithmetic=name, observables=REPORTED, points=3)  # fmt: skip


@cache
def named_a() -> RunResult:
    return named("a", "mpmath")


@pytest.mark.sample(8)
@pytest.mark.parametrize("parameter", OWN_NAMES)
def test_the_name_of_a_parameter_does_not_change_what_is_found(parameter: str) -> None:
    found, expected = named(parameter, "mpmath"), named_a()
    assert expected.status == "finished"
    assert (found.status, found.values) == ("finished", expected.values)
    assert found.series == expected.series


@pytest.mark.parametrize("parameter", ["v5", "k", "lam", "steps", "range"])
def test_the_name_of_a_parameter_does_not_change_what_float64_finds(parameter: str) -> None:
    assert named(parameter, "float64").values == named("a", "float64").values


# -- memory and compilation -----------------------------------------------------------------------

MEMORY = """
import resource, tracemalloc
from verify import Hamiltonian, run
duffing = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})
def series(steps):
    run(duffing, "lie2", q="1.5", p=0, step_size="0.001", steps=steps, points=600)
def peak(steps):
    tracemalloc.start()
    series(steps)
    own = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return own, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
series(500_000)  # compiles, which takes four times as long where it is traced
print(*peak(500_000), *peak(5_000_000))
"""


@pytest.mark.left_to_ci
def test_memory_does_not_grow_with_the_number_of_steps() -> None:
    done = subprocess.run(
        [sys.executable, "-c", MEMORY], capture_output=True, text=True, check=True
    )
    own, resident, own_of_many, resident_of_many = map(int, done.stdout.split())
    assert own_of_many <= 1.1 * own
    assert resident_of_many <= 1.1 * resident


def test_a_grid_of_step_sizes_and_parameters_compiles_one_kernel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # An H of this test's own, so that no other test has compiled its kernel.
    fresh = Hamiltonian.parse("p**2/2 + a*q**2/2 + b*q**6/96 + 71*q**2/1931")
    compiled, compile_one = [], float64._compile_now

    def count(*args: Any) -> Any:
        compiled.append(compile_one(*args))
        return compiled[-1]

    monkeypatch.setattr(float64, "_BREAK_EVEN_STEPS", 0)
    monkeypatch.setattr(float64, "_compile_now", count)
    for h in ("0.01", "0.02", "1/7", "3e-3"):
        for a, b in ((1, 1), ("1/3", -2), (-1, "0.5")):
            run(
                fresh.with_values({"a": a, "b": b}), "lie3", q="0.1", p="0.2", step_size=h, steps=50
            )
    assert len(compiled) == 1
    run(fresh.with_values({"a": 1, "b": 0}), "lie3", q=1, p=0, step_size="0.1", steps=50)
    assert len(compiled) == 2, "a vanishing term has a kernel of its own"
