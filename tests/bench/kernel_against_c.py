"""float64 kernel against the same loop in C: Duffing, lie2, closed-form ΔJ, Λ, MSE and max.

    python tests/bench/kernel_against_c.py

Compiles c/duffing_lie2.c with `cc -O3 -march=native`; without a compiler it says so. The two run in
turn, and what counts is the ratio of the medians within this run. Target: at most 1.2.
"""

import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from verify import arithmetic
from verify.hamiltonians import systems
from verify.kernels.kernel import kernel_for

STEPS, ROUNDS = 50_000_000, 7
TARGET = 1.2


def main() -> None:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        print("no C compiler here; nothing to compare with")
        return
    hamiltonian = systems.get("duffing").hamiltonian()
    observables = frozenset({"delta_j_max", "mse", "lambda"})
    kernel = kernel_for(hamiltonian, "lie2", arithmetic.get("float64", 17), observables)
    start = (0.001, 1.0, 0.0, 1.5, *map(float, kernel.start))
    kernel.function(1_000_000, *start)  # compiles
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "duffing_lie2"
        source = Path(__file__).parent / "c" / "duffing_lie2.c"
        subprocess.run([compiler, "-O3", "-march=native", source, "-o", program, "-lm"], check=True)
        for _ in range(ROUNDS):
            begun = time.perf_counter()
            kernel.function(STEPS, *start)
            ours.append(time.perf_counter() - begun)
            arguments = [str(program), str(STEPS), "0.001", "1", "1.5", "0"]
            output = subprocess.run(arguments, check=True, capture_output=True, text=True).stdout
            theirs.append(float(output.split()[0]))
    ns = {name: statistics.median(x) / STEPS * 1e9 for name, x in [("ours", ours), ("C", theirs)]}
    ratio = ns["ours"] / ns["C"]
    print(f"ours {ns['ours']:.2f} ns, C {ns['C']:.2f} ns a step; ratio {ratio:.2f} (≤ {TARGET})")


if __name__ == "__main__":
    main()
