"""A table of somebody's numbers in n degrees of freedom against the reference data.

What rounding does not explain is tried as a mistake: the columns of p and q, or of two degrees of
freedom, in each other's place, a sign of p, a step index off by one, another scheme of the same
scene. A mistake is named where all of the run's numbers that the right reading does not explain fit
it.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import combinations

from verify.reference.compare.agreement import Cell, Printing, beside
from verify.reference.compare.allowance_in_degrees import AllowanceInDegrees
from verify.reference.compare.compare import Compared, Explained, printings
from verify.reference.compare.findings import Named, Of, RunFindings, Verdict
from verify.reference.compare.published_in_degrees import Bounded, RunOfDegrees
from verify.reference.compare.rows import Row, Theirs
from verify.reference.make.columns import values_of
from verify.reference.make.orbit_points import OrbitInDegrees, orbit_points

_DIGITS = 25  # of a run with a mistake
_MOST_STEPS = 20_000  # of it
Reading = Callable[[int], Mapping[str, Bounded] | None]  # what a row of a step should then hold


def compare_in_degrees(
    ours: Sequence[RunOfDegrees],
    theirs: Theirs[RunOfDegrees],
    done: Callable[[int, int], None] = lambda *_: None,
) -> Compared:
    """Everything of the table that the reference data have; `done` hears of runs, of how many.

    InputError where the table has no row, or no cell, that the data have.
    """
    rows = theirs.kept()
    how = printings(rows)
    found = Compared(rows=len(rows), runs=len(theirs.runs))
    judged = []
    for count, (run, own) in enumerate(theirs.runs.values(), start=1):
        each = _judged(run, own, how, ours)
        if each.columns:
            judged.append(each)
        done(count, len(theirs.runs))
    found.take(theirs.columns, judged)
    counts = Counter(tuple(group) for each in judged for group in each.mistakes)
    found.diagnoses = [Explained(group, count) for group, count in counts.items()]
    return found


class _Judged:
    """One run's cells, as a reading foretells them."""

    def __init__(self, run: RunOfDegrees, rows: Mapping[int, Row], how: Mapping[str, Printing]):
        self.run, self.rows, self.how = run, rows, how
        self.allowance = AllowanceInDegrees(run)
        self.allowed = {}
        for step in sorted(rows):
            numbers = {name: x for name, (x, _) in run.numbers(step).items()}
            self.allowed[step] = self.allowance.at(step, numbers) if numbers else None

    def cells(self, reading: Reading) -> Iterator[tuple[int, str, Cell, Verdict]]:
        """Step, column, the cell and its verdict, of all that are printed."""
        for step in sorted(self.rows):
            known = reading(step) or {}
            for name, text in self.rows[step].cells.items():
                if text.strip() and name in known:
                    row = self.rows[step]
                    what = f"line {row.line}, {name}"
                    cell = beside(text, known[name], self.how[name], what)
                    yield step, name, cell, self._verdict(step, name, cell)

    def _verdict(self, step: int, name: str, cell: Cell) -> Verdict:
        if not cell.differs:
            return Verdict.AGREES
        allowed = self.allowed[step]
        if allowed is None:
            return Verdict.LOST
        if cell.theirs is None or name not in allowed:
            return Verdict.MORE
        if cell.apart <= allowed[name].usual:
            return Verdict.ROUNDING
        return Verdict.PERHAPS if cell.apart <= allowed[name].worst else Verdict.MORE


def _judged(
    run: RunOfDegrees,
    rows: Mapping[int, Row],
    how: Mapping[str, Printing],
    ours: Sequence[RunOfDegrees],
) -> RunFindings:
    judge = _Judged(run, rows, how)
    by_name: dict[str, list[tuple[int, Cell, Verdict]]] = {}
    for step, name, cell, verdict in judge.cells(run.numbers):
        by_name.setdefault(name, []).append((step, cell, verdict))
    lost = min((s for own in by_name.values() for s, _, v in own if v is Verdict.LOST),
               default=None)  # fmt: skip
    found = RunFindings(run.label, {name: _of(own) for name, own in by_name.items()})
    found.lost_from = lost
    if found.verdict is Verdict.MORE:
        fitting = [named for named, reading in _mistakes(run, ours) if _fits(judge, reading)]
        found.mistakes = [fitting] if fitting else []
    return found


def _of(own: Sequence[tuple[int, Cell, Verdict]]) -> Of:
    told = [x for x in own if x[2] is not Verdict.LOST]
    if not told:
        return Of(Verdict.LOST, 0, math.inf, own[0][0], None)
    step, cell, _ = min(told, key=lambda x: x[1].digits)
    verdict = max(x[2] for x in told)
    parts = [s for s, _, v in told if v is Verdict.MORE]
    return Of(verdict, len(told), cell.digits, step, min(parts, default=None))


def _fits(judge: _Judged, reading: Reading) -> bool:
    """Whether it foretells every number of the rows that it knows, and one at least that the right
    reading does not."""
    right = {(step, name): v for step, name, _, v in judge.cells(judge.run.numbers)}
    known = {at: v for at, v in right.items() if reading(at[0]) is not None}
    every = {(step, name): v for step, name, _, v in judge.cells(reading)}
    return (
        known.keys() <= every.keys()
        and max(known.values(), default=Verdict.AGREES) is Verdict.MORE
        and max(every[at] for at in known) <= Verdict.PERHAPS
    )


# -- mistakes -------------------------------------------------------------------------------------


def _mistakes(run: RunOfDegrees, ours: Sequence[RunOfDegrees]) -> Iterator[tuple[Named, Reading]]:
    n = run.hamiltonian.degrees
    degrees = range(1, n + 1)
    swap = {f"p{k}": f"q{k}" for k in degrees}
    yield (
        ("swapped", "your columns of p and q are in each other's place"),
        _renamed(run, swap | {q: p for p, q in swap.items()}),
    )
    for i, j in combinations(degrees, 2):
        pairs = {f"{x}{a}": f"{x}{b}" for x in "pq" for a, b in ((i, j), (j, i))}
        says = f"your degrees of freedom {i} and {j} are in each other's place"
        yield (f"degrees-{i}-{j}", says), _renamed(run, pairs)
    yield ("sign-of-p", "your p has the other sign"), _negated(run)
    both = {"symplectic_defect": "symplectic_defect_max"}
    yield (
        ("defects", "your symplectic_defect is that of one step, the greatest, and not that of N"),
        _renamed(run, both),
    )
    for late, says in ((1, "later"), (-1, "earlier")):
        yield (f"late{late:+d}", f"your rows are those of one step {says}"), _late(run, late)
    for other in ours:
        if other.scene == run.scene and other is not run and _same_start(run, other):
            says = f"your numbers are those of {other.run.scheme}, and not of {run.run.scheme}"
            yield (f"scheme-{other.run.scheme}", says), _of_other(other)


def _same_start(run: RunOfDegrees, other: RunOfDegrees) -> bool:
    a, b = ({n: x for n, x in each.inputs.items() if n != "scheme"} for each in (run, other))
    return a == b


def _of_other(other: RunOfDegrees) -> Reading:
    return lambda step: other.numbers(step) if step in other.rows else None


def _late(run: RunOfDegrees, late: int) -> Reading:
    """Computed where the data do not have that step."""
    given = run.run
    half = run.hamiltonian.degrees
    start = [x for name, x in given.start.items() if name != "t"]
    orbit = OrbitInDegrees(
        run.hamiltonian, given.scheme, Fraction(given.step_size), tuple(start[half:]),
        tuple(start[:half]), Fraction(given.t0 or 0),
    )  # fmt: skip

    @cache
    def read(step: int) -> dict[str, Bounded] | None:
        if step + late < 0 or step > _MOST_STEPS:
            return None
        (point,) = orbit_points(orbit, (step + late,), _DIGITS)
        known = values_of(point, half).items()
        return {name: (Fraction(x.value), Fraction(x.radius)) for name, x in known if x}

    return read


def _renamed(run: RunOfDegrees, names: Mapping[str, str]) -> Reading:
    def read(step: int) -> dict[str, Bounded]:
        known = run.numbers(step)
        wanted = {name: names.get(name, name) for name in known}
        return {name: known[old] for name, old in wanted.items() if old in known}

    return read


def _negated(run: RunOfDegrees) -> Reading:
    def read(step: int) -> dict[str, Bounded]:
        known = run.numbers(step)
        return {name: (-x if name[0] == "p" else x, radius)
                for name, (x, radius) in known.items()}  # fmt: skip

    return read
