"""heyoka's Taylor integrator: adaptive order and step, compiled for this one H.

F. Biscani, D. Izzo, Revisiting high-order Taylor methods for astrodynamics and celestial mechanics,
Monthly Notices of the Royal Astronomical Society 504, 2021.

The tolerance selects the order. Numbers in H that are no binary fractions are rounded to float64.
"""

import time
from fractions import Fraction
from typing import Any

import sympy

from verify.algebra.formula import symbol
from verify.studies.work_precision import peers

NAME = "Taylor (heyoka)"
LIBRARY = "heyoka"
TOLERANCES = tuple(Fraction(1, 10**n) for n in range(3, 16))


def make(problem: peers.InitialValueProblem, tolerance: Fraction) -> peers.Solver:
    """Return a solver of that tolerance. Raises PeerError for an H that heyoka does not take."""
    import heyoka as hy

    start_time = time.perf_counter()
    names = tuple(problem.point)
    variables, n = hy.make_vars(*names), len(names) // 2
    energy = _translate(problem.hamiltonian.exact)
    start, begin = tuple(map(float, problem.point.values())), float(problem.t0)
    end = float(problem.t0 + problem.time)
    pairs = list(zip(variables[:n], variables[n:], strict=True))
    field = [(p, -hy.diff(energy, q)) for p, q in pairs]
    field += [(q, hy.diff(energy, p)) for p, q in pairs]
    taylor = hy.taylor_adaptive(field, list(start), tol=float(tolerance))
    compile_seconds = time.perf_counter() - start_time

    def solve() -> peers.Answer:
        taylor.time = begin
        taylor.state[:] = start
        outcome, _, _, steps, *_ = taylor.propagate_until(end)
        if outcome != hy.taylor_outcome.time_limit:
            raise peers.PeerError(f"heyoka stopped: {outcome}")
        return peers.Answer(tuple(map(float, taylor.state)), int(steps), None)

    return peers.Solver(solve, compile_seconds)


def _translate(expression: sympy.Expr) -> Any:
    import heyoka as hy

    numbers = (x for x in expression.atoms(sympy.Rational) if x.q & (x.q - 1))
    numbers_by_value = {x: hy.expression(float(x)) for x in numbers}
    try:
        return hy.from_sympy(expression, {**numbers_by_value, symbol("t"): hy.time})
    except (ValueError, TypeError) as error:
        raise peers.PeerError(f"heyoka does not take this H: {error}") from None
