"""The comparison of somebody's table with the reference data: which numbers differ, and why."""

from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from verify.errors import InputError
from verify.reference.compare.diagnosis import Diagnosis
from verify.reference.compare.judge import Judge
from verify.reference.compare.published_data import Published, PublishedRun
from verify.reference.compare.run_mistakes import state_mistakes
from verify.reference.compare.scatter import Scatters
from verify.reference.compare.setting import OrbitPoints, Setting
from verify.reference.compare.submitted_table import SubmittedTable
from verify.reference.compare.table_agreement import (
    ColumnFindings,
    ColumnVerdict,
    NamedMistake,
    RunFindings,
    printing,
)
from verify.runs.run_start import Start
from verify.scenes.results.separation import SeparationResult
from verify.structures import AREA, SYMPLECTIC
from verify.studies.separation.truncation_and_rounding import separate

_MAX_VAIN_SEARCHES = 3  # a mistake that all runs have would have been found by then
_MAX_SEPARATED_STEPS = {AREA: 100_000, SYMPLECTIC: 0}  # a separation of W takes too long
_SEPARATED_DIGITS = 3


@dataclass(frozen=True)
class Column(ColumnFindings):
    """One column of all runs together.

    The fewest digits agree at `step` of `run`; `parts_run`: the run that differs first by more than
    rounding.
    """

    name: str
    run: str
    parts_run: str | None


@dataclass(frozen=True)
class Explanation:
    """The explanation of `runs` runs: one mistake, or several that the table cannot distinguish."""

    mistakes: tuple[NamedMistake, ...]
    runs: int


@dataclass(frozen=True)
class WorstSeparation:
    """The Λ that differs most of those that rounding explains, and its separation in float64."""

    run: str
    step: int
    apart: Fraction
    result: SeparationResult


@dataclass(frozen=True)
class TableComparison:
    """The result of a comparison of `runs` runs in `rows` rows.

    `unexplained`: the runs that differ by more than rounding and that no mistake fits. By a run's
    label, `lost`: the step from which rounding may have taken every digit, and `overflows`: the
    first step with a number that is not finite, at which doubles may overflow.
    """

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
    published: Published, table: SubmittedTable, done: Callable[[int, int], None] = lambda *_: None
) -> TableComparison:
    """Compare all numbers of the table that the reference data have, too.

    A verdict is on a column, over all runs together; mistakes are looked for if one differs by more
    than rounding. `done` is called with the number of finished runs and that of all. Raises
    InputError if the table has no row, or no cell, that the data have.
    """
    submitted_rows = table.all_rows()
    printings = {
        name: printing(row.cells[name] for row in submitted_rows) for name in table.columns
    }
    findings: list[RunFindings] = []
    off_by_rounding: list[_RoundedLambda] = []
    search = _MistakeSearch()
    requested_steps = {step for _, rows in table.runs.values() for step in rows}
    # A mistake of the step index shifts rows by one: the neighbours' spreads are needed, too.
    marks = {max(0, step + delay) for step in requested_steps for delay in (-1, 0, 1)}
    scatters = Scatters([run.orbit for run, _ in table.runs.values()], sorted(marks))
    points = OrbitPoints({x.orbit: (x.run.digits, x.rows) for x in published.runs()})
    for count, (run, rows) in enumerate(table.runs.values(), start=1):
        judge = Judge(run, rows, printings, scatters, points)
        if judge.cells:
            run_findings = judge.judge()
            if search.explain(judge, run_findings):
                later_runs = [run for run, _ in list(table.runs.values())[count:]]
                scatters.expect(_orbits(later_runs, points, search.names))
            findings.append(run_findings)
            off_by_rounding += _off_by_rounding(judge, run_findings)
        done(count, len(table.runs))
    if not findings:
        raise InputError("table", "all cells", "are empty where the data have a number")
    compared = {name for x in findings for name in x.columns}
    return TableComparison(
        rows=len(submitted_rows),
        runs=len(table.runs),
        columns=[_summarize_column(name, findings) for name in table.columns if name in compared],
        diagnoses=_diagnoses(findings),
        unexplained=[
            x.label for x in findings if x.verdict is ColumnVerdict.MORE and not x.mistakes
        ],
        lost={x.label: x.lost_from for x in findings if x.lost_from is not None},
        overflows={x.label: x.overflow_from for x in findings if x.overflow_from is not None},
        separated=_separate_worst(off_by_rounding),
    )


class _RoundedLambda(NamedTuple):
    """A Λ whose difference rounding explains; `never_lost`: no step of its run is lost."""

    never_lost: bool
    distance: Fraction
    step: int
    label: str
    orbit: Start


def _off_by_rounding(judge: Judge, findings: RunFindings) -> Iterator[_RoundedLambda]:
    lam = findings.columns.get("lambda")
    if lam is None or lam.verdict not in (ColumnVerdict.ROUNDING, ColumnVerdict.PERHAPS):
        return
    orbit = judge.published_run.orbit
    step_limit = _MAX_SEPARATED_STEPS[orbit.hamiltonian.structure]
    last_step = (
        step_limit if findings.lost_from is None else min(step_limit, findings.lost_from - 1)
    )
    for (step, name), cell in judge.cells.items():
        if name != "lambda" or not 0 < step <= last_step or cell.submitted is None:
            continue
        if cell.distance:
            never_lost = findings.lost_from is None
            yield _RoundedLambda(never_lost, cell.distance, step, findings.label, orbit)


def _separate_worst(off_by_rounding: list[_RoundedLambda]) -> WorstSeparation | None:
    """Separate the run with the greatest difference.

    A run that is lost at some step is taken only if there is no other, since it takes long.
    """
    if not off_by_rounding:
        return None
    _, distance, step, label, orbit = max(off_by_rounding, key=lambda x: (x.never_lost, x.distance))
    result = separate(**orbit.run_arguments, steps=step, digits=_SEPARATED_DIGITS)
    assert isinstance(result, SeparationResult)  # noqa: S101 - tables are of the plane
    return WorstSeparation(label, step, distance, result) if result.plain else None


class _MistakeSearch:
    """A search for mistakes: all in the first runs, and later those that fitted in earlier runs.

    Single precision is looked for in every run, since that costs nothing.
    """

    def __init__(self) -> None:
        self.names: set[str] = set()
        self.in_vain = 0

    def explain(self, judge: Judge, findings: RunFindings) -> bool:
        """Look for mistakes in a run; return True if a new one was found."""
        findings.mistakes = Diagnosis(judge, findings, frozenset(self.names)).mistakes()
        if not findings.mistakes and self.in_vain < _MAX_VAIN_SEARCHES:
            findings.mistakes = Diagnosis(judge, findings).mistakes()
            self.in_vain += findings.verdict is ColumnVerdict.MORE and not findings.mistakes
        before = len(self.names)
        self.names |= {name for group in findings.mistakes for name, _ in group}
        return len(self.names) > before


def _orbits(
    runs: Iterable[PublishedRun], points: OrbitPoints, names: Container[str]
) -> Iterator[Start]:
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
    """Return the groups of mistakes that fit, each with its number of runs.

    If a group of mistakes fits in one run and only some of them in another, the other run rules out
    the rest.
    """
    counts = Counter(
        tuple(fitting) for run_findings in findings for fitting in run_findings.mistakes
    )
    for group in sorted(counts, key=len, reverse=True):
        # With two smaller groups it would be ambiguous, and the larger group stays.
        smaller = [x for x in counts if set(x) < set(group)]
        if len(smaller) == 1:
            counts[smaller[0]] += counts.pop(group)
    return [Explanation(group, count) for group, count in counts.items()]
