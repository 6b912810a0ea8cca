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
from verify.studies.work_precision.peer_interface import (
    Answer,
    InitialValueProblem,
    PeerError,
    Solver,
)

NAME = "Taylor (heyoka)"
LIBRARY = "heyoka"
TOLERANCES = tuple(Fraction(1, 10**n) for n in range(3, 16))


def make(problem: InitialValueProblem, tolerance: Fraction) -> Solver:
    """Raises PeerError for an H that heyoka does not take."""
    import heyoka as hy

    begun = time.perf_counter()
    p, q = hy.make_vars("p", "q")
    h = _translated(problem.hamiltonian.exact)
    start, begin = (float(problem.p), float(problem.q)), float(problem.t0)
    end = float(problem.t0 + problem.time)
    taylor = hy.taylor_adaptive(
        [(p, -hy.diff(h, q)), (q, hy.diff(h, p))], list(start), tol=float(tolerance)
    )
    compiled = time.perf_counter() - begun

    def solve() -> Answer:
        taylor.time = begin
        taylor.state[:] = start
        outcome, _, _, steps, *_ = taylor.propagate_until(end)
        if outcome != hy.taylor_outcome.time_limit:
            raise PeerError(f"heyoka stopped: {outcome}")
        found_p, found_q = taylor.state
        return Answer(float(found_p), float(found_q), int(steps), None)

    return Solver(solve, compiled)


def _translated(expression: sympy.Expr) -> Any:
    import heyoka as hy

    numbers = (x for x in expression.atoms(sympy.Rational) if x.q & (x.q - 1))
    known = {x: hy.expression(float(x)) for x in numbers}
    try:
        return hy.from_sympy(expression, {**known, symbol("t"): hy.time})
    except (ValueError, TypeError) as error:
        raise PeerError(f"heyoka does not take this H: {error}") from None
