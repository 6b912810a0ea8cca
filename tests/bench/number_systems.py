"""The number systems against each other: time of a step in the stepping loop, in µs.

    python tests/bench/number_systems.py

Kernels run in turn, round by round; what counts is the least time of each and ratios within this
run. Targets: mpfr at least 8 times faster than mpmath (Duffing, lie2, with Λ, MSE and max |ΔJ|, at
50 digits), and ball under 2.4 µs (pendulum, symplectic Euler with its determinant, 100 digits).
"""

import time
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

from verify import arithmetic
from verify.hamiltonians import systems
from verify.kernels.kernel import kernel_for

NAMES = "mpmath", "mpfr", "ball"
STEPS, ROUNDS = 3000, 9
SUMS = frozenset({"lambda", "mse", "delta_j_max"})
PLAIN = frozenset({"lambda_plain"})


class Work(NamedTuple):
    system: str
    scheme: str
    observables: frozenset[str]
    digits: int
    q: Fraction
    p: Fraction
    h: Fraction


DUFFING = Fraction(3, 2), Fraction(0), Fraction(1, 1000)
PENDULUM = Fraction(3, 2), Fraction(3, 2), Fraction(1, 100)
WORKS = [
    *(Work("duffing", "lie2", SUMS, digits, *DUFFING) for digits in (33, 50, 72)),
    *(Work("pendulum", "lie2", SUMS, digits, *PENDULUM) for digits in (33, 50, 72)),
    Work("pendulum", "symplectic-euler", PLAIN, 100, *DUFFING),
]
FASTER = {("duffing", 50): 8.0}  # mpfr against mpmath
MICROSECONDS = {("pendulum", 100): 2.4}  # ball


def stepper(work: Work, name: str) -> Callable[[int], object]:
    """The kernel from its start, in its arithmetic's context; every parameter of H is 1."""
    made = arithmetic.get(name, work.digits)
    hamiltonian = systems.get(work.system).hamiltonian()
    kernel = kernel_for(hamiltonian, work.scheme, made, work.observables)
    start = [work.h, *(1 for _ in kernel.parameters), work.p, work.q, *kernel.start]
    numbers = [made.number(Fraction(x)) for x in start]

    def go(steps: int) -> object:
        with made.context():
            return kernel.function(steps, *numbers)

    return go


def measured(work: Work) -> dict[str, float]:
    """The least time of a step in each number system, in µs."""
    steppers = {name: stepper(work, name) for name in NAMES}
    least = dict.fromkeys(NAMES, float("inf"))
    for _ in range(ROUNDS):
        for name, go in steppers.items():
            begun = time.perf_counter()
            go(STEPS)
            least[name] = min(least[name], (time.perf_counter() - begun) / STEPS * 1e6)
    return least


def main() -> None:
    for work in WORKS:
        least = measured(work)
        key = work.system, work.digits
        faster = f" (≥ {FASTER[key]:g})" if key in FASTER else ""
        below = f" (< {MICROSECONDS[key]:g})" if key in MICROSECONDS else ""
        print(
            f"{work.system}, {work.scheme}, {work.digits} digits: mpmath {least['mpmath']:.2f} µs, "
            f"mpfr {least['mpfr']:.2f} µs, ball {least['ball']:.2f} µs{below} a step; "
            f"mpmath / mpfr {least['mpmath'] / least['mpfr']:.1f}{faster}, "
            f"mpmath / ball {least['mpmath'] / least['ball']:.1f}"
        )


if __name__ == "__main__":
    main()
