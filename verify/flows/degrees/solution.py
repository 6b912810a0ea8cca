"""The exact solution at one time, with its error bound, in any number of degrees of freedom.

H is taken apart into what is not coupled. A part in one degree of freedom is the plane's
(`verify.flows.solution`), with its closed forms; Kepler's problem has one where the orbit is an
ellipse; all else is followed by the numerical flow, with more digits until two of them agree.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

import sympy

from verify.algebra.formula import symbol
from verify.effort import MOST, unless_long
from verify.errors import InputError
from verify.flows.closed_form import MOST_DIGITS, many_on_grid, until
from verify.flows.solution import ITSELF, Point, Solution, exact_solution, numerical_solution
from verify.hamiltonians import kepler_motion
from verify.hamiltonians.coordinates import PLANE, numbered
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.systems import get

_ELLIPSE = "closed form of Kepler's ellipse"


def solution_in_degrees(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction = Fraction(0)
) -> Solution:
    """φ_time(point), whose bound is at most 10^−digits times the largest coordinate at both ends.

    Time may be negative; t0 is when it begins where H depends on it. Raises InputError for a
    parameter without a value, and NoFlowError, saying why, where no solution reaches that time.
    """
    if hamiltonian.symbols:
        raise InputError("parameter", hamiltonian.symbols[0], "needs a value")
    if not 1 <= digits <= MOST_DIGITS:
        raise InputError("digits", digits, f"must be 1 … {MOST_DIGITS}")
    if time == 0:
        return Solution(point, Fraction(0), ITSELF)
    parts = [] if hamiltonian.planar else uncoupled(hamiltonian)
    if len(parts) < 2:
        return _of_part(hamiltonian, point, time, digits, t0)
    found: dict[str, Fraction] = {}
    solutions = []
    for part, names in parts:
        own = {name: point[old] for name, old in zip(part.coordinates, names, strict=True)}
        solved = _of_part(part, own, time, digits, t0)
        solutions.append(solved)
        found |= {old: solved.point[name] for name, old in zip(own, names, strict=True)}
    return Solution(
        {name: found[name] for name in hamiltonian.coordinates},
        max(solved.bound for solved in solutions),
        "; ".join(dict.fromkeys(solved.method for solved in solutions)),
        all(solved.enclosed for solved in solutions),
    )


def uncoupled(hamiltonian: Hamiltonian) -> list[tuple[Hamiltonian, tuple[str, ...]]]:
    """H as a sum of Hamiltonians in coordinates of their own: each, in p and q or p1 … qn, with the
    names that these have in H. What is coupled with nothing and does not move is left together."""
    degrees = hamiltonian.degrees
    groups = {k: {k} for k in range(1, degrees + 1)}
    exact = hamiltonian.exact
    terms = sympy.Add.make_args(unless_long(lambda: sympy.expand(exact), exact))
    for term in terms:
        numbers = sorted(_numbers(term, hamiltonian.coordinates))
        together = set[int]().union(*(groups[k] for k in numbers)) if numbers else set[int]()
        groups |= dict.fromkeys(together, together)
    parts = sorted({min(g): sorted(g) for g in groups.values()}.values())
    if len(parts) == 1:
        return [(hamiltonian, hamiltonian.coordinates)]
    return [_part(terms, own, hamiltonian.coordinates) for own in parts]


def _numbers(term: sympy.Expr, coordinates: Sequence[str]) -> set[int]:
    """Which degrees of freedom are in it."""
    return {int(s.name[1:]) for s in term.free_symbols if s.name in coordinates}


def _part(
    terms: Sequence[sympy.Expr], own: Sequence[int], coordinates: Sequence[str]
) -> tuple[Hamiltonian, tuple[str, ...]]:
    old = tuple(f"{letter}{k}" for letter in PLANE for k in own)
    new = PLANE if len(own) == 1 else numbered(len(own))
    put = {symbol(a): symbol(b) for a, b in zip(old, new, strict=True)}
    inside = [x for x in terms if _numbers(x, coordinates) & set(own)]
    return Hamiltonian(sympy.Add(*inside).xreplace(put)), old


def _of_part(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int, t0: Fraction
) -> Solution:
    if tuple(point) == PLANE:
        return exact_solution(hamiltonian, **point, time=time, digits=digits, t0=t0)
    return _ellipse(hamiltonian, point, time, digits) or numerical_solution(
        hamiltonian, point, time, digits, t0
    )


def _ellipse(
    hamiltonian: Hamiltonian, point: Point, time: Fraction, digits: int
) -> Solution | None:
    """Where H is Kepler's and the orbit is bound; None for all else."""
    mu = unless_long(lambda: _strength(hamiltonian), None, MOST)
    if mu is None:
        return None
    q, p = (point["q1"], point["q2"]), (point["p1"], point["p2"])
    if not kepler_motion.is_ellipse(mu, q, p):
        return None
    start = list(point.values())
    found = until(lambda: many_on_grid(kepler_motion.after(mu, q, p, time), start, digits), digits)
    after = dict(zip(("p1", "p2", "q1", "q2"), found[0], strict=True))
    return Solution(after, found[1], _ELLIPSE)


@lru_cache(maxsize=64)
def _strength(hamiltonian: Hamiltonian) -> Fraction | None:
    """μ, where H is Kepler's but for a constant."""
    kepler = get("kepler").hamiltonian({}).expression
    if len(hamiltonian.coordinates) != 4 or hamiltonian.time_dependent:
        return None
    if hamiltonian.exact.is_polynomial():  # seen at once, where simplifying takes seconds
        return None
    mu = symbol("mu")
    # At q = (1, 0) and p = 0 it is −μ, and at q = (2, 0) half of that.
    at = [dict.fromkeys(map(symbol, ("p1", "p2", "q2")), 0) | {symbol("q1"): k} for k in (1, 2)]
    first, second = (hamiltonian.exact.subs(x) for x in at)
    value = sympy.nsimplify(2 * (second - first)) if (second - first).is_number else None
    if value is None or not value.is_Rational:
        return None
    gap = sympy.simplify(hamiltonian.exact - kepler.subs(mu, value))
    same = gap.is_number and not gap.free_symbols
    return Fraction(int(value.p), int(value.q)) if same else None
