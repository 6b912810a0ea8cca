"""`fixed` against C with MPFR and against tight mpmath: lie2 with Λ, MSE and max |ΔJ|, per step.

    python tests/bench/fixed_against_mpfr.py [--arithmetic fixed] [--rounds 5] [--systems duffing]

C is c/duffing_lie2_mpfr.c and pendulum_lie2_mpfr.c, compiled here with `cc -O3 -march=native` where
there are a compiler and MPFR's headers; tight mpmath is tight_mpmath.py, with mpf's operators and
with libmp's functions, at the bits that C has. All run in turn, round by round, and what counts is
the ratio of the medians within this run. Before that all of them are held against one run with 64
more bits: a competitor that computes something else is no competitor.
"""

import argparse
import math
import shutil
import statistics
import subprocess
import tempfile
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import tight_mpmath
from mpmath import libmp
from tight_mpmath import DELTA, NAMES, STEP_SIZE, P, Q, Result

from verify import arithmetic
from verify.hamiltonians import systems
from verify.kernels.stepping import KernelRun

IN_C = Path(__file__).parent / "c"
BITS = {33: 113, 53: 170, 72: 240}  # digits asked of us → bits of the competitors
# At least so many times faster than C, and than mpmath, at these digits.
TARGETS: dict[str, dict[int, tuple[float, float]]] = {
    "duffing": {33: (8, 250), 53: (5, 130), 72: (4.5, 80)},
    "pendulum": {33: (5, 100), 53: (4, 100), 72: (4, 100)},
}
COMPARED_STEPS = 2000
Run = Callable[[int], Result]
SLICE = 0.3  # seconds of one measurement
ROUNDING = 4  # allowed error after N steps, in units of N · 2^−bits
# Fixed point has an absolute precision, and 16 of its bits before the point; a step of lie2 has
# some ten roundings, which the orbit stretches.
ROUNDING_OF_OURS = 16


def ours(system: str, digits: int, steps: int, name: str = "fixed") -> Result:
    """Seconds of the stepping and the results, in the project's own arithmetic of that name."""
    hamiltonian = systems.get(system).hamiltonian({"delta": DELTA} if system == "duffing" else {})
    start = {"h": Fraction(STEP_SIZE), "q": Fraction(Q), "p": Fraction(P)}
    observables = frozenset({"lambda", "mse", "delta_j_max"})
    kernel_run = KernelRun(hamiltonian, "lie2", start, steps, observables, points=0)
    outcome = kernel_run.run(arithmetic.get(name, digits))
    return outcome.seconds, {x: outcome.values[x] for x in NAMES}


def compiled(folder: Path, systems_asked: list[str]) -> dict[str, Path]:
    """The competitors in C by system; none where they cannot be compiled."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        print("no C compiler here: C with MPFR is left out\n")
        return {}
    programs = {}
    for system in systems_asked:
        program, source = folder / system, IN_C / f"{system}_lie2_mpfr.c"
        flags = ["-O3", "-march=native", "-o", str(program), "-lmpfr", "-lgmp"]
        made = subprocess.run([compiler, str(source), *flags], capture_output=True, text=True)
        if made.returncode:
            print(f"{source.name} does not compile (is libmpfr-dev there?): C is left out\n")
            return {}
        programs[system] = program
    return programs


def in_c(program: Path, system: str, bits: int, steps: int) -> Result:
    numbers = [STEP_SIZE, DELTA, Q, P] if system == "duffing" else [STEP_SIZE, Q, P]
    command = [str(program), str(steps), str(bits), *numbers]
    seconds, *found = subprocess.run(
        command, check=True, capture_output=True, text=True
    ).stdout.split()
    values = (libmp.to_rational(libmp.from_str(x, bits, "n")) for x in found)
    rationals = (Fraction(*map(int, x)) for x in values)
    return float(seconds), dict(zip(NAMES, rationals, strict=True))


def check(system: str, bits: int, runs: dict[str, Run]) -> None:
    """Stop where a competitor's results are not those of a run with 64 more bits."""
    _, true = getattr(tight_mpmath, system)(COMPARED_STEPS, 0, bits=bits + 64)
    found = {name: run(COMPARED_STEPS)[1] for name, run in runs.items()}
    shown = []
    for name, values in found.items():
        error = float(max(abs(values[x] - true[x]) for x in NAMES) * 2**bits)
        if error > (ROUNDING_OF_OURS if name == "ours" else ROUNDING) * COMPARED_STEPS:
            raise SystemExit(f"{system}, {bits} bits: {name} is {error:.3g} · 2^-{bits} off")
        relative = float(abs(values["lambda"] / true["lambda"] - 1)) or 2.0**-bits
        shown.append(f"{name} {error:.3g}, {-math.log10(relative):.0f} digits of Λ")
    if system == "duffing" and len({tuple(found[x].values()) for x in runs if x != "ours"}) != 1:
        raise SystemExit("C and mpmath round alike, operation by operation, and yet differ")
    print(f"{system:9} errors in 2^-{bits}: {'; '.join(shown)}")


def measure(runs: dict[str, Run], rounds: int) -> dict[str, float]:
    """The median nanoseconds of a step of each, measured in turn."""
    steps = {}
    for name, run in runs.items():
        seconds, _ = run(COMPARED_STEPS)
        steps[name] = max(COMPARED_STEPS, int(SLICE * COMPARED_STEPS / max(seconds, 1e-9)))
    taken: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(rounds):
        for name, run in runs.items():
            taken[name].append(run(steps[name])[0] / steps[name] * 1e9)
    return {name: statistics.median(x) for name, x in taken.items()}


def competitors(system: str, digits: int, programs: dict[str, Path], name: str) -> dict[str, Run]:
    bits, in_mpmath = BITS[digits], getattr(tight_mpmath, system)
    runs: dict[str, Run] = {"ours": lambda n: ours(system, digits, n, name)}
    if programs:
        runs["C"] = lambda n: in_c(programs[system], system, bits, n)
    runs["libmp"] = lambda n: in_mpmath(n, digits, bits=bits)
    runs["mpf"] = lambda n: in_mpmath(n, digits, bits=bits, operators=True)
    return runs


def show(system: str, digits: int, taken: dict[str, float]) -> None:
    least_c, least_mpmath = TARGETS[system][digits]
    for name in (x for x in taken if x != "ours"):
        least = least_c if name == "C" else least_mpmath
        ratio = taken[name] / taken["ours"]
        print(
            f"{system:9} {digits:6} {taken['ours']:10.1f}   {name:6} {BITS[digits]:4} bits "
            f"{taken[name]:8.0f} {ratio:8.2f}   ≥ {least:<4} {'' if ratio >= least else 'MISSED'}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--arithmetic", default="fixed")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--systems", nargs="+", choices=list(TARGETS), default=list(TARGETS))
    asked = parser.parse_args()
    name = asked.arithmetic
    if name not in arithmetic.names():
        stand_in = "mpfr" if "mpfr" in arithmetic.names() else "mpmath"
        print(f"there is no arithmetic {name!r}: {stand_in} stands in, the targets are not its\n")
        name = stand_in
    with tempfile.TemporaryDirectory() as folder:
        programs = compiled(Path(folder), asked.systems)
        cases = [(system, digits) for system in asked.systems for digits in BITS]
        for system, digits in cases:
            check(system, BITS[digits], competitors(system, digits, programs, name))
        print("\nsystem    digits    ours ns   against              ns   faster   target")
        for system, digits in cases:
            runs = competitors(system, digits, programs, name)
            show(system, digits, measure(runs, asked.rounds))


if __name__ == "__main__":
    main()
