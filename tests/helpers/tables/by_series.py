"""By how much one step of a table differs from the exact flow: of power series, without conditions.

Numbers are fractions, of irrational ones the first 60 digits; the series are those of
`tests.helpers.stepping.steps_in_time`.
"""

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import cycle
from typing import Any

import sympy

from tests.helpers.stepping.steps_in_time import (
    Problem,
    Series,
    clock,
    constant,
    flow,
    moved,
    problem,
    runge_kutta_step,
    splitting_step,
)

F = Fraction
State = tuple[Series, Series]
_SIGNS = str.maketrans("−", "-")


def value(text: object, numbers: Mapping[str, Any] | None = None) -> Fraction:
    """The number that is written."""
    plain = re.sub(r"√(\d+)", r"sqrt(\1)", str(text).translate(_SIGNS).replace(" ", ""))
    known = {name: sympy.sympify(str(x), rational=True) for name, x in (numbers or {}).items()}
    found = sympy.sympify(plain, locals=known, rational=True)
    return F(int(found.p), int(found.q)) if found.is_Rational else F(str(sympy.N(found, 60)))


def gap(table: Mapping[str, Any], order: int, timed: bool = False, seeds: int = 2) -> float:
    """The largest coefficient of h … h^order by which a step is not the flow."""
    kinds = {
        ("nystrom", False): "quadratic",
        ("runge-kutta-nystrom", False): "quadratic",
        ("runge-kutta", False): "any",
        ("additive", False): "any",
    }
    kind = kinds.get((table["kind"], False), "autonomous")
    if table.get("time_dependent") == "T and V":
        kind = "general"
    if table["kind"] == "partitioned" and not table.get("separable"):
        kind = "any"
    worst = F(0)
    for seed in range(seeds):
        at = problem(seed + 1, kind)
        at = at if timed else frozen(at)
        step, exact = one_step(table, at, order, timed), flow(at, order)
        sizes = (
            abs(x - y) for a, b in zip(step, exact, strict=True) for x, y in zip(a, b, strict=True)
        )
        worst = max(worst, *sizes)
    return float(min(worst, F(10) ** 300))


def frozen(at: Problem) -> Problem:
    """The same without time: its powers are taken at t = 0."""
    h_p, h_q = ({x: c for x, c in h.items() if x[2] == 0} for h in (at.h_p, at.h_q))
    return Problem(h_p, h_q, at.start)


def one_step(table: Mapping[str, Any], at: Problem, most: int, timed: bool) -> State:
    """The step's series."""
    return _STEPS[table["kind"]](table, at, most, timed)


def sizes_of(table: Mapping[str, Any]) -> list[Fraction]:
    numbers = table.get("numbers", {})
    own = table.get("sizes") or table["half"]
    texts = own.split() if isinstance(own, str) else own
    found = [value(x, numbers) for x in texts]
    return found if "sizes" in table else [*found, *found[-2::-1]]


def _splitting(table: Mapping[str, Any], at: Problem, most: int, timed: bool) -> State:
    sizes = sizes_of(table)
    both = ("kick", "drift") if table["first"] == "kick" else ("drift", "kick")
    kinds = [kind for kind, _ in zip(cycle(both), sizes, strict=False)]
    times = [F(0)] * len(sizes)
    if timed:
        own = table["times"]
        own = own.split() if isinstance(own, str) else own
        times = [F(0) if x == "-" else value(x) for x in own]
    return splitting_step(at, list(zip(kinds, sizes, times, strict=True)), most)


def _composition(table: Mapping[str, Any], at: Problem, most: int, _: bool) -> State:
    shares = (("kick", F(1, 2)), ("drift", F(1)), ("kick", F(1, 2)))
    parts = [(kind, w * share, F(0)) for w in sizes_of(table) for kind, share in shares]
    return splitting_step(at, parts, most)


Tableau = tuple[list[list[Fraction]], list[Fraction], list[Fraction]]


def tableau_of(table: Mapping[str, Any], numbers: Mapping[str, Any]) -> Tableau:
    """a, b and c; without printed times the row sums."""
    if "tableau" in table:
        lines = [x for x in table["tableau"].strip().splitlines() if "--" not in x]
        rows = [[value(x) for x in line.split("|")[1].split()] for line in lines[:-1]]
        weights = [value(x) for x in lines[-1].split("|")[1].split()]
        times = [value(line.split("|")[0]) for line in lines[:-1]]
    else:
        rows = [[value(x, numbers) for x in row] for row in table["a"]]
        weights = [value(x, numbers) for x in table["b"]]
        times = [value(x, numbers) for x in table.get("c", [])]
    count = len(weights)
    rows = [[]] * (count - len(rows)) + rows
    full = [[*row, *[F(0)] * (count - len(row))] for row in rows]
    return full, weights, times or [sum(row, F(0)) for row in full]


def _runge_kutta(table: Mapping[str, Any], at: Problem, most: int, _: bool) -> State:
    return runge_kutta_step(at, *tableau_of(table, table.get("numbers", {})), most)


def _of_parts(table: Mapping[str, Any], at: Problem, most: int, _: bool) -> State:
    """Partitioned, or additive with f_1 = (p', 0) and f_2 = (0, q')."""
    numbers = table.get("numbers", {})
    own = [table["p"], table["q"]] if table["kind"] == "partitioned" else table["parts"]
    (a, b, c), (u, v, w) = (tableau_of(each, numbers) for each in own)
    forces = speeds = [constant(F(0), most)] * len(b)

    def sums(first: Sequence[Fraction], second: Sequence[Fraction]) -> State:
        p, q = (constant(x, most) for x in at.start[:2])
        for x, y, force, speed in zip(first, second, forces, speeds, strict=True):
            p, q = moved(p, force, x), moved(q, speed, y)
        return p, q

    for _turn in range(most):
        stages = [sums(x, y) for x, y in zip(a, u, strict=True)]
        forces = [at.slope((*z, clock(at, t, most)))[0] for z, t in zip(stages, c, strict=True)]
        speeds = [at.slope((*z, clock(at, t, most)))[1] for z, t in zip(stages, w, strict=True)]
    return sums(b, v)


def _nystrom(table: Mapping[str, Any], at: Problem, most: int, _: bool) -> State:
    """For H = 3 p²/2 + V: q' = 3 p."""
    rows, weights, times = tableau_of(table, {})
    bar = [value(x) for x in table["b_bar"]]
    mass = F(3, 2) * 2
    p, q = (constant(x, most) for x in at.start[:2])
    forces = [constant(F(0), most)] * len(weights)

    def place(row: Sequence[Fraction], c: Fraction) -> Series:
        found = moved(q, [mass * x for x in p], c)
        for a, force in zip(row, forces, strict=True):
            found = moved(found, moved(constant(F(0), most), force, a * mass))
        return found

    for _turn in range(most):
        forces = [
            at.slope((p, place(row, c), clock(at, c, most)))[0]
            for row, c in zip(rows, times, strict=True)
        ]
    after = p
    for b, force in zip(weights, forces, strict=True):
        after = moved(after, force, b)
    return after, place(bar, F(1))


_STEPS = {
    "splitting": _splitting,
    "nystrom": _splitting,
    "composition": _composition,
    "runge-kutta": _runge_kutta,
    "partitioned": _of_parts,
    "additive": _of_parts,
    "runge-kutta-nystrom": _nystrom,
}
