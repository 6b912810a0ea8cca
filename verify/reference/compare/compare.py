"""A table of somebody's numbers against the reference data: what agrees, what parts, and why."""

from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from verify.errors import InputError
from verify.reference.compare.agreement import printing
from verify.reference.compare.diagnosis import Diagnosis
from verify.reference.compare.findings import Named, Of, RunFindings, Verdict
from verify.reference.compare.judge import Judge
from verify.reference.compare.mistakes import of_states
from verify.reference.compare.published import Published, PublishedRun
from verify.reference.compare.rows import Theirs
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
class Column(Of):
    """The same of a column of all runs together: at `step` of `run` the fewest digits agree, and
    `parts_run` first differs by more than rounding."""

    name: str
    run: str
    parts_run: str | None


@dataclass(frozen=True)
class Explained:
    """What fits in so many runs: one mistake, or several that the table does not tell apart."""

    mistakes: tuple[Named, ...]
    runs: int


@dataclass(frozen=True)
class Separated:
    """The Λ that is off most by what rounding may do, and that run's separation in float64."""

    run: str
    step: int
    apart: Fraction
    result: SeparationResult


@dataclass(frozen=True)
class Compared:
    """`runs` were compared in so many `rows`. `unexplained`: runs that differ by more than rounding
    and no mistake fits. `lost`: steps from which rounding may have taken every digit, by run;
    `overflows`: the first ones with a number that is not finite where doubles may overflow."""

    rows: int
    runs: int
    columns: list[Column]
    diagnoses: list[Explained]
    unexplained: list[str]
    lost: dict[str, int]
    overflows: dict[str, int]
    separated: Separated | None

    @property
    def agrees(self) -> bool:
        """Whether nothing is there that rounding cannot explain."""
        return not self.diagnoses and all(x.verdict is not Verdict.MORE for x in self.columns)


def compare(
    ours: Published, theirs: Theirs, done: Callable[[int, int], None] = lambda *_: None
) -> Compared:
    """Everything of the table that the reference data have; `done` hears of runs, of how many.

    Verdicts are of columns, over all runs together; mistakes are looked for where one differs by
    more than rounding. InputError where the table has no row, or no cell, that the data have.
    """
    kept = theirs.kept()
    how = {name: printing(row.cells[name] for row in kept) for name in theirs.columns}
    judged: list[RunFindings] = []
    off: list[_Off] = []  # Λ, by no more than rounding may do
    search = _Search()
    asked = {step for _, rows in theirs.runs.values() for step in rows}
    marks = {max(0, step + late) for step in asked for late in (-1, 0, 1)}
    scatters = Scatters([run.orbit for run, _ in theirs.runs.values()], sorted(marks))
    points = Points({own.orbit: (own.run.digits, own.rows) for own in ours.runs()})
    for count, (run, rows) in enumerate(theirs.runs.values(), start=1):
        judge = Judge(run, rows, how, scatters, points)
        if judge.cells:
            each = judge.judged()
            if search.explain(judge, each):
                rest = [run for run, _ in list(theirs.runs.values())[count:]]
                scatters.expect(_orbits(rest, points, search.known))
            judged.append(each)
            off += _off_by_rounding(judge, each)
        done(count, len(theirs.runs))
    if not judged:
        raise InputError("table", "all cells", "are empty where the data have a number")
    compared = {name for x in judged for name in x.columns}
    return Compared(
        rows=len(kept),
        runs=len(theirs.runs),
        columns=[_column(name, judged) for name in theirs.columns if name in compared],
        diagnoses=_diagnoses(judged),
        unexplained=[x.label for x in judged if x.verdict is Verdict.MORE and not x.mistakes],
        lost={x.label: x.lost_from for x in judged if x.lost_from is not None},
        overflows={x.label: x.overflow_from for x in judged if x.overflow_from is not None},
        separated=_separated(off),
    )


# Whether its run is never lost; how far, when, where.
_Off = tuple[bool, Fraction, int, str, Start]


def _off_by_rounding(judge: Judge, judged: RunFindings) -> Iterator[_Off]:
    of = judged.columns.get("lambda")
    if of is None or of.verdict not in (Verdict.ROUNDING, Verdict.PERHAPS):
        return
    orbit = judge.ours.orbit
    most = _MOST_SEPARATED[orbit.hamiltonian.structure]
    last = most if judged.lost_from is None else min(most, judged.lost_from - 1)
    for (step, name), cell in judge.cells.items():
        if name != "lambda" or not 0 < step <= last or cell.theirs is None:
            continue
        if cell.apart:
            yield judged.lost_from is None, cell.apart, step, judged.label, orbit


def _separated(off: list[_Off]) -> Separated | None:
    """Of runs that are lost only where there is no other: their separation takes long."""
    if not off:
        return None
    _, apart, step, label, orbit = max(off, key=lambda x: x[:2])
    result = separate(**orbit.asked, steps=step, digits=_SEPARATED_DIGITS)
    assert isinstance(result, SeparationResult)  # noqa: S101 - tables are of the plane
    return Separated(label, step, apart, result) if result.plain else None


class _Search:
    """Looks for mistakes: in the first runs among all, in the others among those found before, and
    single precision, which costs nothing to see."""

    def __init__(self) -> None:
        self.known: set[str] = set()
        self.in_vain = 0

    def explain(self, judge: Judge, judged: RunFindings) -> bool:
        """Whether it has found one that was not known."""
        judged.mistakes = Diagnosis(judge, judged, frozenset(self.known)).mistakes()
        if not judged.mistakes and self.in_vain < _MOST_SEARCHES:
            judged.mistakes = Diagnosis(judge, judged).mistakes()
            self.in_vain += judged.verdict is Verdict.MORE and not judged.mistakes
        before = len(self.known)
        self.known |= {name for group in judged.mistakes for name, _ in group}
        return len(self.known) > before


def _orbits(runs: Iterable[PublishedRun], points: Points, names: Container[str]) -> Iterator[Start]:
    """What runs with one of these mistakes would be."""
    for run in runs:
        for mistake in of_states(Setting(run.orbit, points)):
            if mistake.name in names:
                yield mistake.setting.orbit


def _column(name: str, judged: Iterable[RunFindings]) -> Column:
    own = [(x.label, x.columns[name]) for x in judged if name in x.columns]
    label, least = min(own, key=lambda x: x[1].digits)
    parted = [(of.parts_at, label) for label, of in own if of.parts_at is not None]
    parts_at, parts_run = min(parted, default=(None, None))
    verdict, rows = max(of.verdict for _, of in own), sum(of.rows for _, of in own)
    return Column(verdict, rows, least.digits, least.step, parts_at, name, label, parts_run)


def _diagnoses(judged: Iterable[RunFindings]) -> list[Explained]:
    """Which mistakes fit in how many runs. Where several fit in one of them, and some of these in
    all of another, the other rules out the rest."""
    counts = Counter(tuple(fitting) for each in judged for fitting in each.mistakes)
    for group in sorted(counts, key=len, reverse=True):
        smaller = [x for x in counts if set(x) < set(group)]
        if len(smaller) == 1:
            counts[smaller[0]] += counts.pop(group)
    return [Explained(group, count) for group, count in counts.items()]
