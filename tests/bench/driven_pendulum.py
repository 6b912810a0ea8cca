"""The driven pendulum p²/2 − (1 + cos(2t)/2) cos q in `fixed` against C with MPFR: lie2, per step.

    python tests/bench/driven_pendulum.py [--rounds 7]

With Λ, MSE and max |ΔJ|, in the way of fixed_against_mpfr.py; C is c/driven_pendulum_lie2_mpfr.c.
Both are held against a run in mpfr with 100 digits first.
"""

import argparse
import statistics
import tempfile
from fractions import Fraction
from pathlib import Path

import fixed_against_mpfr
from fixed_against_mpfr import BITS, COMPARED_STEPS, in_c
from tight_mpmath import NAMES, STEP_SIZE, P, Q, Result

from verify import arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.stepping import KernelRun

DRIVEN, NAME = "p**2/2 - (1 + cos(2*t)/2)*cos(q)", "driven_pendulum"
TARGET, STEPS = 8, 100_000


def ours(name: str, digits: int, steps: int) -> Result:
    start = {"h": Fraction(STEP_SIZE), "q": Fraction(Q), "p": Fraction(P), "t": Fraction(0)}
    observables = frozenset({"lambda", "mse", "delta_j_max"})
    run = KernelRun(Hamiltonian.parse(DRIVEN), "lie2", start, steps, observables, points=0)
    outcome = run.run(arithmetic.get(name, digits))
    return outcome.seconds, {x: outcome.values[x] for x in NAMES}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=7)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        programs = fixed_against_mpfr.compiled(Path(folder), [NAME])
        if not programs:
            raise SystemExit("there is nothing to compare with")
        _, true = ours("mpfr", 100, COMPARED_STEPS)
        print(f"{'digits':>6}{'ours ns':>9}{'C ns':>8}{'faster':>8}   target {TARGET}")
        for digits, bits in BITS.items():
            for found in (
                ours("fixed", digits, COMPARED_STEPS)[1],
                in_c(programs[NAME], NAME, bits, COMPARED_STEPS)[1],
            ):
                worst = max(abs(found[x] - true[x]) for x in NAMES)
                if worst * 2**bits > 16 * COMPARED_STEPS:
                    raise SystemExit(f"{digits} digits: off by {float(worst):.3g}")
            taken = [
                (ours("fixed", digits, STEPS)[0], in_c(programs[NAME], NAME, bits, STEPS)[0])
                for _ in range(asked.rounds)
            ]
            own, c = (statistics.median(x) / STEPS * 1e9 for x in zip(*taken, strict=True))
            print(f"{digits:6}{own:9.1f}{c:8.0f}{c / own:8.1f}", flush=True)


if __name__ == "__main__":
    main()
