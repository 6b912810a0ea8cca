"""Compare somebody's table of numbers with the reference data: where they agree, where they
differ, and why."""

from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from verify.errors import InputError
from verify.reference.compare.agreement import printing
from verify.reference.compare.diagnosis import Diagnosis
from verify.reference.compare.findings import (
    ColumnFindings,
    ColumnVerdict,
    NamedMistake,
    RunFindings,
)
from verify.reference.compare.judge import Judge
from verify.reference.compare.mistakes import state_mistakes
from verify.reference.compare.published import Published, PublishedRun
from verify.reference.compare.rows import SubmittedTable
from verify.reference.compare.scatter import Scatters
from verify.reference.compare.setting import Points, Setting
from verify.runs.start import Start
from verify.scenes.results.separation import SeparationResult
from verify.structures import AREA, SYMPLECTIC
from verify.studies.separation.separate import separate

_MOST_SEARCHES = 3  # in vain: a mistake that they all had would have been found
_MOST_SEPARATED = {AREA: 100_000, SYMPLECTIC: 0}  # steps: with S it takes long
_SEPARATED_DIGITS = 3


@dataclass(frozen=True)
class Column(ColumnFindings):
    """One column of all runs together: the fewest digits agree at `step` of `run`, and
    `parts_run` is the first to differ by more than rounding."""

    name: str
    run: str
    parts_run: str | None


@dataclass(frozen=True)
class Explanation:
    """The explanation of so many runs: one mistake, or several that the table does not tell
    apart."""

    mistakes: tuple[NamedMistake, ...]
    runs: int


@dataclass(frozen=True)
class WorstSeparation:
    """The Λ that is off most within what rounding may do, and that run's separation in float64."""

    run: str
    step: int
    apart: Fraction
    result: SeparationResult


@dataclass(frozen=True)
class Comparison:
    """The result: `runs` were compared in so many `rows`. `unexplained`: runs that differ by
    more than rounding and no mistake fits. `lost`: steps from which rounding may have taken
    every digit, by run; `overflows`: the first ones with a number that is not finite where
    doubles may overflow."""

    rows: int
    runs: int
    columns: list[Column]
    diagnoses: list[Explanation]
    unexplained: list[str]
    lost: dict[str, int]
    overflows: dict[str, int]
    separated: WorstSeparation | None

    @property
    def agrees(self) -> bool:
        """True if rounding explains every difference."""
        return not self.diagnoses and all(x.verdict is not ColumnVerdict.MORE for x in self.columns)


def compare(
    ours: Published, theirs: SubmittedTable, done: Callable[[int, int], None] = lambda *_: None
) -> Comparison:
    """Compare all numbers of the table that the reference data have, too; `done` is called with the
    finished runs and the number of all.

    Verdicts are of columns, over all runs together; mistakes are looked for where one differs by
    more than rounding. Raises InputError where the table has no row, or no cell, that the data
    have.
    """
    kept_rows = theirs.all_rows()
    how = {name: printing(row.cells[name] for row in kept_rows) for name in theirs.columns}
    findings: list[RunFindings] = []
    off: list[_Off] = []  # Λ, by no more than rounding may do
    search = _Search()
    requested_steps = {step for _, rows in theirs.runs.values() for step in rows}
    # A mistake of the step index shifts rows by one: the neighbours' spreads are needed, too.
    marks = {max(0, step + late) for step in requested_steps for late in (-1, 0, 1)}
    scatters = Scatters([run.orbit for run, _ in theirs.runs.values()], sorted(marks))
    points = Points({x.orbit: (x.run.digits, x.rows) for x in ours.runs()})
    for count, (run, rows) in enumerate(theirs.runs.values(), start=1):
        judge = Judge(run, rows, how, scatters, points)
        if judge.cells:
            each = judge.judge()
            if search.explain(judge, each):
                rest = [run for run, _ in list(theirs.runs.values())[count:]]
                scatters.expect(_orbits(rest, points, search.names))
            findings.append(each)
            off += _off_by_rounding(judge, each)
        done(count, len(theirs.runs))
    if not findings:
        raise InputError("table", "all cells", "are empty where the data have a number")
    compared = {name for x in findings for name in x.columns}
    return Comparison(
        rows=len(kept_rows),
        runs=len(theirs.runs),
        columns=[_summarize_column(name, findings) for name in theirs.columns if name in compared],
        diagnoses=_diagnoses(findings),
        unexplained=[
            x.label for x in findings if x.verdict is ColumnVerdict.MORE and not x.mistakes
        ],
        lost={x.label: x.lost_from for x in findings if x.lost_from is not None},
        overflows={x.label: x.overflow_from for x in findings if x.overflow_from is not None},
        separated=_separate_worst(off),
    )


# Whether its run is never lost; how far, when, where.
_Off = tuple[bool, Fraction, int, str, Start]


def _off_by_rounding(judge: Judge, findings: RunFindings) -> Iterator[_Off]:
    lam = findings.columns.get("lambda")
    if lam is None or lam.verdict not in (ColumnVerdict.ROUNDING, ColumnVerdict.PERHAPS):
        return
    orbit = judge.ours.orbit
    most = _MOST_SEPARATED[orbit.hamiltonian.structure]
    last = most if findings.lost_from is None else min(most, findings.lost_from - 1)
    for (step, name), cell in judge.cells.items():
        if name != "lambda" or not 0 < step <= last or cell.theirs is None:
            continue
        if cell.distance:
            yield findings.lost_from is None, cell.distance, step, findings.label, orbit


def _separate_worst(off: list[_Off]) -> WorstSeparation | None:
    """Separate the worst run; of runs that are lost only where there is no other, since they
    take long."""
    if not off:
        return None
    _, distance, step, label, orbit = max(off, key=lambda x: x[:2])
    result = separate(**orbit.run_arguments, steps=step, digits=_SEPARATED_DIGITS)
    assert isinstance(result, SeparationResult)  # noqa: S101 - tables are of the plane
    return WorstSeparation(label, step, distance, result) if result.plain else None


class _Search:
    """A search for mistakes: in the first runs among all, in the others among those found
    before, and single precision, which costs nothing to see."""

    def __init__(self) -> None:
        self.names: set[str] = set()
        self.in_vain = 0

    def explain(self, judge: Judge, findings: RunFindings) -> bool:
        """Look for mistakes in a run; return True if a new one was found."""
        findings.mistakes = Diagnosis(judge, findings, frozenset(self.names)).mistakes()
        if not findings.mistakes and self.in_vain < _MOST_SEARCHES:
            findings.mistakes = Diagnosis(judge, findings).mistakes()
            self.in_vain += findings.verdict is ColumnVerdict.MORE and not findings.mistakes
        before = len(self.names)
        self.names |= {name for group in findings.mistakes for name, _ in group}
        return len(self.names) > before


def _orbits(runs: Iterable[PublishedRun], points: Points, names: Container[str]) -> Iterator[Start]:
    """Yield the orbits of the runs with one of these mistakes."""
    for run in runs:
        for mistake in state_mistakes(Setting(run.orbit, points)):
            if mistake.name in names:
                yield mistake.setting.orbit


def _summarize_column(name: str, findings: Iterable[RunFindings]) -> Column:
    columns = [(x.label, x.columns[name]) for x in findings if name in x.columns]
    label, least = min(columns, key=lambda x: x[1].digits)
    departures = [
        (column.parts_at, label) for label, column in columns if column.parts_at is not None
    ]
    parts_at, parts_run = min(departures, default=(None, None))
    verdict = max(column.verdict for _, column in columns)
    rows = sum(column.rows for _, column in columns)
    return Column(verdict, rows, least.digits, least.step, parts_at, name, label, parts_run)


def _diagnoses(findings: Iterable[RunFindings]) -> list[Explanation]:
    """Return which mistakes fit in how many runs.

    Where several fit in one run, and some of these in all of another, the other rules out the rest.
    """
    counts = Counter(tuple(fitting) for each in findings for fitting in each.mistakes)
    for group in sorted(counts, key=len, reverse=True):
        # Only an unambiguous reduction is made: with two candidates both explanations stay.
        smaller = [x for x in counts if set(x) < set(group)]
        if len(smaller) == 1:
            counts[smaller[0]] += counts.pop(group)
    return [Explanation(group, count) for group, count in counts.items()]
