"""Orbits in lanes against one orbit alone, and against C with MPFR: per step and orbit.

    python tests/bench/lanes.py [--orbits 8] [--rounds 7] [--systems duffing pendulum morse]

lie2 with Λ, MSE and max |ΔJ|, with the tangent map that a certificate needs (`certified`) and
without. All run in turn, round by round, and what counts is the ratio of the medians within this
run. Before that each orbit in lanes is held against the same one alone, bit for bit. C is that of
fixed_against_mpfr.py, which carries no tangent map.
"""

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import fixed_against_mpfr
import numpy as np
from tight_mpmath import DELTA

from verify import arithmetic
from verify.arithmetic.compiled.translation import Layout
from verify.arithmetic.lanes.vectors import LANES
from verify.hamiltonians import systems
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.chunked_loop import ChunkedLoop
from verify.kernels.kernel import Kernel, kernel_for
from verify.kernels.stepping import KernelRun

STEPS = 50_000
BITS = dict(sorted({**fixed_against_mpfr.BITS, 42: 142}.items()))  # 42: three limbs, as 33
TARGETS = {"duffing": 5, "pendulum": 3}  # times less than one orbit alone
AGAINST_C = 40
STARTS: dict[str, tuple[dict[str, str], Fraction]] = {  # parameters; the middle of the first q
    "duffing": ({"delta": DELTA}, Fraction(1)),
    "morse": ({"D": "1", "a": "1"}, Fraction(1)),
}
SOFTENED = "p**2/2 - 1/sqrt(1 + q**2)"  # has no name


def loops(system: str, digits: int, orbits: int, certified: bool) -> tuple[Kernel, list[Any]]:
    """The kernel, and each orbit's loop from its own initial value."""
    made = arithmetic.get("fixed", digits)
    parameters, around = STARTS.get(system, ({}, Fraction(1)))
    if system == SOFTENED:
        hamiltonian = Hamiltonian.parse(system)
    else:
        hamiltonian = systems.get(system).hamiltonian(parameters)
    asked = frozenset({"lambda", "mse", "delta_j_max"})
    found = []
    for k in range(orbits):
        q = around + Fraction(9 - 2 * k, 18)
        start = {"h": Fraction(1, 1000), "q": q, "p": Fraction(k, 7)}
        run = KernelRun(hamiltonian, "lie2", start, STEPS, asked, points=0)
        more = {"tangent"} if certified else set()
        kernel = kernel_for(run.hamiltonian, "lie2", made, asked | more)
        shift, limits = next(run.formats(kernel, made))
        found.append(ChunkedLoop(run, kernel, made, limits[: len(kernel.limits)], shift))
    return kernel, found


def words_of(layout: Layout, each: list[Any]) -> Any:
    """The arguments of all orbits, a column each."""
    packed = [layout.pack((STEPS, *loop.fixed, *loop.state)) for loop in each]
    return np.ascontiguousarray(
        np.stack([np.frombuffer(row, dtype=np.uint64) for row in packed], axis=1)
    )


def timed(call: Callable[[], Any]) -> float:
    begun = time.perf_counter()
    call()
    return time.perf_counter() - begun


def measure(system: str, digits: int, orbits: int, certified: bool, rounds: int) -> list[float]:
    """Nanoseconds of a step and orbit: alone, and in lanes."""
    kernel, each = loops(system, digits, orbits, certified)
    function: Any = kernel.function
    words = words_of(function.layout, each)
    parts = [np.ascontiguousarray(words[:, k : k + 1]) for k in range(orbits)]
    alone = np.concatenate([function.orbit_kernel(part) for part in parts], axis=1)
    if function.lane_kernel is None:
        raise SystemExit("no lanes here; VERIFY_LANES=portable forces slow ones")
    sets = [np.ascontiguousarray(words[:, k : k + LANES]) for k in range(0, orbits, LANES)]
    together = np.concatenate([function.lane_kernel(part) for part in sets], axis=1)
    if not np.array_equal(alone, together):
        raise SystemExit(f"{system}, {digits} digits: an orbit in lanes is another one")
    taken: list[list[float]] = [[], []]
    for _ in range(rounds):
        taken[0].append(timed(lambda: function.orbit_kernel(parts[0])) / STEPS)
        taken[1].append(timed(lambda: [function.lane_kernel(s) for s in sets]) / STEPS / orbits)
    return [statistics.median(x) * 1e9 for x in taken]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--orbits", type=int, default=8)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--systems", nargs="+", default=[*TARGETS, "morse", SOFTENED])
    asked = parser.parse_args()
    if asked.orbits % LANES:
        raise SystemExit(f"--orbits {asked.orbits}: give a multiple of {LANES}")
    print(
        f"{'':9}{'digits':>7}{'certified':>11}{'alone':>9}{'lanes':>8}{'ratio':>7}{'C':>9}{'C/lanes':>9}"
    )
    with tempfile.TemporaryDirectory() as folder:
        in_c = [system for system in asked.systems if system in fixed_against_mpfr.TARGETS]
        programs = fixed_against_mpfr.compiled(Path(folder), in_c)
        for system in asked.systems:
            for digits, bits in BITS.items():
                for certified in (True, False):
                    alone, lanes = measure(system, digits, asked.orbits, certified, asked.rounds)
                    line = f"{system[:9]:9}{digits:7}{'yes' if certified else 'no':>11}"
                    line += f"{alone:9.1f}{lanes:8.1f}{alone / lanes:7.2f}"
                    if system in programs:
                        runs = [
                            fixed_against_mpfr.in_c(programs[system], system, bits, STEPS)[0]
                            for _ in range(asked.rounds)
                        ]
                        c = statistics.median(runs) / STEPS * 1e9
                        line += f"{c:9.0f}{c / lanes:9.1f}"
                    print(line, flush=True)
            if system in TARGETS:
                print(f"{system:9}target: {TARGETS[system]} times less than alone")


if __name__ == "__main__":
    main()
