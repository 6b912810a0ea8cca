"""Short runs of random sparse polynomials H: kernels and runs a second, by scheme and arithmetic.

    python tests/bench/short_runs.py [--count 20]

alone       each H is new: its step map, its kernels and what bounds them are made for that one run
together    all runs of a scene after one another, as a battery of scenes has them: of one new H a
            run in every arithmetic and a separation, which share what is made of the map

Targets, in the mean over the schemes of `together`: a run in 5 ms, a separation in 12 ms.
"""

import argparse
import contextlib
import random
import statistics
import time
from collections.abc import Callable
from fractions import Fraction

from verify import arithmetic as number_systems
from verify import lockstep
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.kernels.kernel import kernel_for
from verify.runs.requested_run import run
from verify.studies.separation.links import separate_chains
from verify.studies.separation.mixed_run import Stopped

STEPS, H = 8, Fraction(1, 100)
P, Q = Fraction(1, 3), Fraction(1, 2)
DIGITS = {"float64": 17, "mpfr": 30, "mpmath": 30, "ball": 30}
SEPARATION = "separation"
SHEARS = "symplectic-euler", "stormer-verlet"  # which take H = T(p) + V(q) alone
SCHEMES = "lie1", "lie2", "lie3", "lie4", "rk4", "explicit-midpoint", *SHEARS
TARGETS = dict.fromkeys(DIGITS, 5.0) | {SEPARATION: 12.0}  # ms
MOST_DEGREE, MOST_TERMS = 6, 4


def drawn(draw: random.Random, scheme: str) -> Hamiltonian:
    """A polynomial of degree 1 … 6 in 1 … 4 terms."""
    terms: list[str] = []
    count = draw.randint(1, MOST_TERMS)
    while len(terms) < count:
        m, n = draw.randint(0, MOST_DEGREE), draw.randint(0, MOST_DEGREE)
        if scheme in SHEARS and m and n:
            m, n = draw.choice([(m, 0), (0, n)])
        if 0 < m + n <= MOST_DEGREE:
            factor = draw.choice([1, -1]) * draw.randint(1, 9)
            terms.append(f"({factor}/{draw.randint(1, 9)})*p**{m}*q**{n}")
    return Hamiltonian.parse(" + ".join(terms))


def one_run(hamiltonian: Hamiltonian, scheme: str, name: str) -> None:
    if name == SEPARATION:
        with contextlib.suppress(Stopped):  # an answer too
            lockstep.run_alone(
                separate_chains(hamiltonian, scheme, {"p": P, "q": Q, "h": H}, STEPS, 8)
            )
        return
    run(hamiltonian, scheme, q=Q, p=P, step_size=H, steps=STEPS, arithmetic=name,
        digits=DIGITS[name], observables=("lambda",))  # fmt: skip


def one_kernel(hamiltonian: Hamiltonian, scheme: str, name: str) -> None:
    made = number_systems.get(name, DIGITS[name])
    kernel_for(hamiltonian.with_symbols(), scheme, made, frozenset({"lambda"}))


def seconds(what: Callable[[Hamiltonian, str, str], None], *given: object) -> float:
    begun = time.process_time()
    what(*given)  # type: ignore[arg-type]
    return time.process_time() - begun


def alone(scheme: str, name: str, count: int) -> tuple[float, float]:
    """Seconds of a kernel and of a run, of new Hamiltonians each."""
    draw = random.Random(f"{scheme} {name}")  # noqa: S311 - no secret
    kernels, runs = [], []
    for _ in range(count):
        if name in DIGITS:
            kernels.append(seconds(one_kernel, drawn(draw, scheme), scheme, name))
        runs.append(seconds(one_run, drawn(draw, scheme), scheme, name))
    return statistics.mean(kernels or [0.0]), statistics.mean(runs)


def together(scheme: str, count: int) -> dict[str, float]:
    """Seconds of each run of a scene, the first one with all that the others share."""
    draw = random.Random(scheme)  # noqa: S311 - no secret
    taken: dict[str, list[float]] = {name: [] for name in TARGETS}
    for _ in range(count):
        hamiltonian = drawn(draw, scheme)
        for name, times in taken.items():
            times.append(seconds(one_run, hamiltonian, scheme, name))
    return {name: statistics.mean(times) for name, times in taken.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--count", type=int, default=20, help="Hamiltonians for each figure")
    count = parser.parse_args().count
    draw = random.Random(0)  # noqa: S311 - no secret
    for name in TARGETS:  # imports and the first calls of libraries
        one_run(drawn(draw, "lie2"), "lie2", name)
    for scheme in SCHEMES:
        for name in TARGETS:
            kernel, whole = alone(scheme, name, count)
            kernels = f"{1 / kernel:8.0f} kernels/s" if kernel else " " * 18
            print(f"alone     {scheme:18}{name:12}{kernels}{1 / whole:8.0f} runs/s", flush=True)
    means: dict[str, list[float]] = {name: [] for name in TARGETS}
    for scheme in SCHEMES:
        found = {name: 1000 * x for name, x in together(scheme, count).items()}
        for name, x in found.items():
            means[name].append(x)
        shown = "  ".join(f"{name} {x:.1f}" for name, x in found.items())
        print(f"together  {scheme:18}{shown}  all {sum(found.values()):.1f} ms", flush=True)
    for name, own in means.items():
        mean, most = statistics.mean(own), TARGETS[name]
        missed = "" if mean <= most else "   MISSED"
        print(f"{name:12} {mean:6.1f} ms in the mean   target ≤ {most:g} ms{missed}")


if __name__ == "__main__":
    main()
