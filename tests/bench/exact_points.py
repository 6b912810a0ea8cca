"""How much faster many points are carried together than one by one by `exact_solution`.

    python tests/bench/exact_points.py

5000 points about (p, q) = (0, 1/2), to t = 50, 100 and 200 (to 10 where no closed form is known),
from nothing compiled or kept; one by one with 17 digits, timed on a part of them.
"""

import time
from fractions import Fraction

import numpy as np

from verify.flows.points import exact_points
from verify.flows.solution import exact_solution
from verify.hamiltonians.hamiltonian import Hamiltonian

COUNT, REPEATS = 5000, 3
LONG, SHORT = (Fraction(50), Fraction(100), Fraction(200)), (Fraction(10),)
FORMULAS = {
    "pendulum": ("p**2/2 - cos(q)", LONG, 40),
    "duffing-hard": ("p**2/2 + q**2/2 + q**4/4", LONG, 40),
    "duffing-soft": ("p**2/2 + q**2/2 - q**4/4", LONG, 40),
    "double-well": ("p**2/2 + (q**2 - 1)**2/4", LONG, 40),
    "morse": ("p**2/2 + 2*(1 - exp(-q))**2", LONG, 40),
    "toda": ("p**2/2 + exp(q) + exp(-q)", LONG, 40),
    "toda-oscillator": ("p**2/2 + exp(q) - q - 1", SHORT, 4),
    "parabola": ("p**2/(2*(1 + q**2)) + q**2/2", SHORT, 4),
}


def main() -> None:
    rng = np.random.default_rng(1)
    p, q = rng.uniform(-0.3, 0.3, (2, COUNT)) + np.array([[0.0], [0.3]])
    print(f"{'system':>16} {'together s':>10} {'one by one s':>12} {'ratio':>6} {'bound':>8} alone")
    for name, (formula, times, part) in FORMULAS.items():
        h = Hamiltonian.parse(formula)
        together = []
        for _ in range(REPEATS):
            began = time.perf_counter()
            found = exact_points(h, {"p": p, "q": q}, times)
            together.append(time.perf_counter() - began)
        began = time.perf_counter()
        for x, y in zip(p[:part], q[:part], strict=True):
            for t in times:
                exact_solution(h, p=Fraction(x), q=Fraction(y), time=t, digits=17)
        single = (time.perf_counter() - began) * COUNT / part
        best = min(together)
        print(
            f"{name:>16} {best:10.3f} {single:12.1f} {single / best:6.0f} "
            f"{found.bound:8.1e} {len(found.outliers)}",
            flush=True,
        )


if __name__ == "__main__":
    main()
