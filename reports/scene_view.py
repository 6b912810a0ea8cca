"""A scene as the page shows it: its schemes, each with proof, criteria, figures and runs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from reports import mathml, plots
from reports.claim_view import ClaimView
from reports.plots import Plot
from reports.typography import listed, start, value, whole
from verify.criteria import NAMES
from verify.results import CriterionResult, ProofResult, RunResult, SceneResult

MOST_ROWS = 600  # of a table of runs; the others are in results.json
_COLUMNS = {
    "mse": "MSE",
    "delta_j_max": "max |ΔJ|",
    "lambda": "Λ by closed form",
    "lambda_plain": "Λ the plain way",
}


@dataclass(frozen=True)
class RunRow:
    step_size: str
    steps: str
    cells: tuple[Markup, ...]  # empty where the run left the arithmetic's range
    failure: str


@dataclass(frozen=True)
class RunTable:
    """The runs of one scheme: a column an observable, a group an initial value."""

    columns: tuple[str, ...]
    groups: tuple[tuple[str, tuple[RunRow, ...]], ...]
    count: int
    shown: int
    computed: str
    proved: tuple[str, ...]  # the columns that a proof gave, for all runs


@dataclass(frozen=True)
class SchemeView:
    proof: ProofResult
    anchor: str
    criteria: tuple[tuple[CriterionResult, str], ...]  # each with what it asks for
    matrix: Markup | None
    leading: Markup | None
    plots: tuple[Plot, ...]
    series: tuple[Plot, ...]
    runs: RunTable | None


@dataclass(frozen=True)
class TableView:
    """A table of the paper: the claim that holds it, and the picture of it."""

    claim: ClaimView
    plot: Plot | None


@dataclass(frozen=True)
class SceneView:
    result: SceneResult
    anchor: str
    symbols: tuple[str, ...]  # parameters without a value
    floors: str  # a sentence on the step sizes that do not divide the time
    tables: tuple[TableView, ...]
    schemes: tuple[SchemeView, ...]


def scene_view(scene: SceneResult, anchor: str, tables: Sequence[ClaimView]) -> SceneView:
    names = mathml.free_names(scene.hamiltonian)
    return SceneView(
        result=scene,
        anchor=anchor,
        symbols=tuple(n for n in names if n not in scene.parameters),
        floors=_floors(scene),
        tables=tuple(
            TableView(claim, plots.table(claim, name=f"table-{index}-of-{anchor}"))
            for index, claim in enumerate(tables)
        ),
        schemes=tuple(
            _scheme_view(scene, proof, f"scheme-{index}-of-{anchor}")
            for index, proof in enumerate(scene.proofs)
        ),
    )


def _scheme_view(scene: SceneResult, proof: ProofResult, anchor: str) -> SchemeView:
    runs = [run for run in scene.runs if run.scheme == proof.scheme]
    series = [run for run in scene.series if run.scheme == proof.scheme and run.series]
    leading = None
    if proof.order is not None:
        leading = mathml.order_equation(proof.leading, proof.order)
    return SchemeView(
        proof=proof,
        anchor=anchor,
        criteria=tuple(
            (c, NAMES.get(c.number, "")) for c in scene.criteria if c.scheme == proof.scheme
        ),
        matrix=mathml.matrix(mathml.NAMED["J"], proof.jacobian),
        leading=leading,
        plots=tuple(plots.against_step_size(runs, scene, proof, name=anchor)),
        series=tuple(
            plots.over_time(run, name=f"time-{index}-of-{anchor}")
            for index, run in enumerate(series)
        ),
        runs=_run_table(runs),
    )


def _floors(scene: SceneResult) -> str:
    """Which step sizes do not divide the time, with the N that is taken instead."""
    if scene.time is None:
        return ""
    time = Fraction(scene.time)
    rest = {
        r.step_size: r.steps
        for r in (*scene.runs, *scene.series)
        if time // Fraction(r.step_size) == r.steps and r.steps * Fraction(r.step_size) != time
    }
    if not rest:
        return ""
    shown = listed(f"h = {h} gives N = {whole(n)}" for h, n in rest.items())
    return f"Where T/h is not a whole number, N is T/h rounded down: {shown}."


def _run_table(runs: Sequence[RunResult]) -> RunTable | None:
    names = [n for n in _COLUMNS if any(n in run.values for run in runs)]
    failed = any(run.status == "left range" for run in runs)
    if not names and not failed:
        return None
    shown = runs[:MOST_ROWS]
    return RunTable(
        columns=tuple(_COLUMNS[n] for n in names) or ("outcome",),
        groups=tuple(_groups(shown, names)),
        count=len(runs),
        shown=len(shown),
        computed=plots.computed(runs),
        proved=tuple(_COLUMNS[n] for n in names if all(n in run.exact for run in runs)),
    )


def _groups(
    runs: Sequence[RunResult], names: Sequence[str]
) -> Iterator[tuple[str, tuple[RunRow, ...]]]:
    groups: dict[str, list[RunRow]] = {}
    for run in runs:
        groups.setdefault(start(run), []).append(_row(run, names))
    for label, rows in groups.items():
        yield label, tuple(rows)


def _row(run: RunResult, names: Sequence[str]) -> RunRow:
    failure = ""
    if run.status == "left range":
        failure = f"left the range of {run.arithmetic}"
        if run.failed_step is not None:
            failure += f" at step {whole(run.failed_step)}"
    cells = tuple(value(run.values[n]) if n in run.values else Markup("–") for n in names)
    return RunRow(run.step_size, whole(run.steps), () if failure else cells, failure)
