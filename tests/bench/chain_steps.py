"""What a step of the chain `fput` costs with the state alone, for n = 4 … 64 masses.

python tests/bench/chain_steps.py

A step should cost so many times what its force does, which is the scheme `kick 1`, however many
masses there are. Operations are
counted in the kernel; microseconds are the least of the rounds, an empty call subtracted; the
kernel is compiled anew. Results stand in docs/explanation/speed.md.
"""

import os
import time
from fractions import Fraction

from verify import code_cache
from verify.arithmetic.systems import float64
from verify.hamiltonians.systems import get
from verify.kernels.kernel import kernel_for
from verify.kernels.stepping import KernelRun
from verify.studies.work_precision.timing import time_interleaved

_STEPS, _ROUNDS = 2000, 5
_SCHEMES = ("kick 1", "stormer-verlet", "lie2", "rk4", "lie4")
_SIZES = (4, 8, 16, 32, 64)


def main() -> None:
    os.environ[code_cache.VARIABLE] = code_cache.OFF
    for scheme in _SCHEMES:
        for n in _SIZES:
            print(f"{scheme:15} n = {n:2}: {_measured(scheme, n)}", flush=True)


def _measured(scheme: str, n: int) -> str:
    hamiltonian = get("fput").hamiltonian({"n": n, "alpha": "1/4", "beta": "1/2"})
    point = dict.fromkeys(hamiltonian.coordinates, Fraction(0)) | {"q1": Fraction(1, 10)}
    start = {**point, "h": Fraction(1, 100), "t": Fraction(0)}
    run = KernelRun(hamiltonian, scheme, start, _STEPS, frozenset(), 0)
    own = float64.compiled_at_once()
    begun = time.thread_time()
    kernel = kernel_for(run.hamiltonian, scheme, own, frozenset())
    written = time.thread_time()
    given = [own.number(x) for x in (*run.inputs(kernel, 0).values(), *point.values())]
    kernel.function(0, *given)
    compiled = time.thread_time()
    calls = [lambda: kernel.function(_STEPS, *given), lambda: kernel.function(0, *given)]
    whole, empty = (each.least for each in time_interleaved(calls, _ROUNDS))
    operations = sum(op.kind in ("add", "sub", "mul") for op in kernel.program.ops)
    return (
        f"{operations:6} operations, {(whole - empty) / _STEPS * 1e6:7.3f} µs a step, "
        f"written in {written - begun:.2f} s, compiled in {compiled - written:.2f} s"
    )


if __name__ == "__main__":
    main()
