"""The energy beside Λ over N steps of lie2, with its bound: at most 1.25 times the run without it.

    python tests/bench/kept_integrals.py [--digits 33] [--rounds 25]

Both runs of a pair are stepped in turn, with the tangent map that their bounds need, and the least
time of each counts.
"""

import argparse
from fractions import Fraction

from verify import arithmetic
from verify.arithmetic.number_system import Arithmetic
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import point_of
from verify.kernels.stepping import KernelRun

TARGET = 1.25
PLAIN = frozenset({"lambda"})
STEPS = {"fixed": 200_000, "mpfr": 3000}
SYSTEMS = {
    "Duffing": ("p**2/2 + q**2/2 + q**4/4", "1.5", "0"),
    "pendulum": ("p**2/2 - cos(q)", "1", "0"),
    "Hénon–Heiles": (
        "(p1**2 + p2**2 + q1**2 + q2**2)/2 + q1**2*q2 - q2**3/3",
        ["0.1", "0.2"], ["0.1", "0.3"],
    ),
    "not separable": ("p**2/2 + p*q/10 + q**6/6 + exp(q)/7", "0.5", "0.2"),
}  # fmt: skip


def _least(runs: list[KernelRun], numbers: Arithmetic, rounds: int) -> list[float]:
    """The least seconds of each of the runs, which take turns."""
    seconds = [[run.run(numbers, tangent=True).seconds for run in runs] for _ in range(rounds)]
    return [min(column) for column in zip(*seconds, strict=True)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--digits", type=int, default=33)
    parser.add_argument("--rounds", type=int, default=25)
    chosen = parser.parse_args()
    for system, (formula, q, p) in SYSTEMS.items():
        exact = Hamiltonian.parse(formula)
        start = {**point_of(exact, q, p), "h": Fraction(1, 1000), "t": Fraction(0)}
        for name, steps in STEPS.items():
            numbers = arithmetic.get(name, chosen.digits)
            requests = (PLAIN, PLAIN | {"energy_error", "energy_error_max"})
            runs = [KernelRun(exact, "lie2", start, steps, x, 0) for x in requests]
            seconds = _least(runs, numbers, chosen.rounds)
            share = seconds[1] / seconds[0]
            each = " and ".join(f"{x / steps * 1e6:.3f} µs" for x in seconds)
            verdict = "" if share <= TARGET else "MISSED"
            print(f"{system:14} {name:6} {each:24} {share:.3f}  target {TARGET} {verdict}")


if __name__ == "__main__":
    main()
