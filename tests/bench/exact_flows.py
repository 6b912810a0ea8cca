"""How long the exact flow takes: closed form, Gragg's method, and the Lie series at high order.

`python tests/bench/exact_flows.py`: from (0, 3/2) to t = 100. The Lie series is the scheme lieη
with η growing with the digits, its terms made as power series in t (ball arithmetic), since their
formulas in p and q do not end. Its step is as long as its last terms allow.
"""

import time
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

import flint

from verify.flows.extrapolation import NumericalFlow
from verify.flows.solution import exact_solution
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.hamiltonian import Hamiltonian

END, Q0 = 100, Fraction(3, 2)
DIGITS = (16, 30, 60)
Slopes = Callable[[Any, Any], tuple[Any, Any]]


def lennard_jones(p: Any, q: Any) -> tuple[Any, Any]:
    w = q.inv()
    w6 = (w * w) * (w * w) * (w * w)
    return 4 * (12 * w6 * w6 - 6 * w6) * w, p


SYSTEMS: dict[str, tuple[str, Slopes]] = {
    "duffing": ("p**2/2 + q**2/2 + q**4/4", lambda p, q: (-(q + q * q * q), p)),
    "pendulum": ("p**2/2 - cos(q)", lambda p, q: (-q.sin(), p)),
    "lennard-jones": ("p**2/2 + 4*(1/q**12 - 1/q**6)", lennard_jones),
}


def lie_series(slopes: Slopes, digits: int) -> Any:
    """q(END) by Taylor steps of the order that so many digits need."""
    order = max(20, digits * 11 // 10 + 10)
    arb, series = flint.arb, flint.arb_series
    least = arb(10) ** -(digits + 6)
    p, q, at = arb(0), arb(3) / 2, arb(0)
    with flint.ctx.workprec(int((digits + 12) * 3.33)):
        while True:
            flint.ctx.cap = order + 2
            x, y = series([p]), series([q])
            for k in range(1, order + 1):
                flint.ctx.cap = k
                dx, dy = slopes(x, y)
                flint.ctx.cap = k + 1
                x, y = series([p]) + dx.integral(), series([q]) + dy.integral()
            terms = [[*s.coeffs(), *[arb(0)] * order][: order + 1] for s in (x, y)]
            size = least * (abs(p) + abs(q))
            step = min(
                float(((size / (abs(c[k]) + arb(10) ** -300)) ** (arb(1) / k)).mid())
                for c in terms
                for k in (order - 1, order)
            )
            last = bool(at + step >= END)
            h = END - at if last else arb(step)
            p, q = (sum((c * h**k for k, c in enumerate(cs)), arb(0)).mid() for cs in terms)
            at = (at + h).mid()
            if last:
                return q


def gragg(formula: str, digits: int) -> Any:
    flow = NumericalFlow(canonical_field(Hamiltonian.parse(formula))[0], digits)
    return flow.follow((flow.number(Fraction(0)), flow.number(Q0)), Fraction(END))[1]


def whole(formula: str, digits: int) -> Any:
    hamiltonian = Hamiltonian.parse(formula)
    return exact_solution(hamiltonian, p=Fraction(0), q=Q0, time=Fraction(END), digits=digits)


def seconds(call: Callable[[], Any], repeats: int = 2) -> float:
    best = float("inf")
    for _ in range(repeats):
        began = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - began)
    return best


def main() -> None:
    print(f"{'system':>14} {'digits':>6} {'Gragg s':>9} {'Lie s':>9} {'exact_solution s':>17}")
    for name, (formula, slopes) in SYSTEMS.items():
        for digits in DIGITS:
            times = (
                seconds(partial(gragg, formula, digits)),
                seconds(partial(lie_series, slopes, digits), 1),
                seconds(partial(whole, formula, digits)),
            )
            print(
                f"{name:>14} {digits:6} {times[0]:9.3f} {times[1]:9.3f} {times[2]:17.4f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
