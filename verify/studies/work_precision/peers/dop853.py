"""scipy's DOP853: the explicit Runge–Kutta method of order 8 of Dormand and Prince, step control
and all (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.5 and II.10).

Its vector field is compiled; the method itself is Python, as scipy ships it.
"""

import time
from collections.abc import Sequence
from fractions import Fraction

from verify.arithmetic.systems import float64
from verify.flows.compiled_functions import functions_at
from verify.hamiltonians.canonical_field import canonical_field
from verify.studies.work_precision import peers

NAME = "DOP853"
LIBRARY = "scipy"
TOLERANCES = tuple(Fraction(1, 10**n) for n in range(3, 14))  # scipy's limit is 100 · 2⁻⁵²


def make(problem: peers.InitialValueProblem, tolerance: Fraction) -> peers.Solver:
    """Return a solver with rtol = atol = tolerance."""
    from scipy.integrate import solve_ivp

    start_time = time.perf_counter()
    field, _ = canonical_field(problem.hamiltonian)
    names = (*field.names, "t") if field.timed else field.names
    slopes = functions_at(
        float64.compiled_at_once(), [(field.ring, x) for x in field.slopes], names
    )
    start, begin = tuple(map(float, problem.point.values())), float(problem.t0)
    end = float(problem.t0 + problem.time)
    slopes(*start, *(begin,)[: field.timed])  # the first call compiles
    compile_seconds = time.perf_counter() - start_time

    def autonomous_field(_: float, z: Sequence[float]) -> tuple[float, ...]:
        slope_values: tuple[float, ...] = slopes(*z)
        return slope_values

    def time_dependent_field(t: float, z: Sequence[float]) -> tuple[float, ...]:
        slope_values: tuple[float, ...] = slopes(*z, t)
        return slope_values

    def solve() -> peers.Answer:
        solution = solve_ivp(
            time_dependent_field if field.timed else autonomous_field, (begin, end), start,
            method="DOP853", t_eval=(end,), rtol=float(tolerance), atol=float(tolerance),
        )  # fmt: skip
        if not solution.success:
            raise peers.PeerError(solution.message)
        return peers.Answer(tuple(map(float, solution.y[:, -1])), None, int(solution.nfev))

    return peers.Solver(solve, compile_seconds)
