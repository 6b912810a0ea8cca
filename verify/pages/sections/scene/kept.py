"""What each scheme keeps of a scene's system.

A table of schemes by structures, details of each structure in a row, and H − H₀ along the series of
a scene that asks for energy.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from verify import observables
from verify.pages.figures.captioned_plot import Plot, captioned_plot, describe_runs, known_digits
from verify.pages.sections.section import Picture, ReportSection
from verify.pages.sections.table_rows import by_key
from verify.pages.text import legend
from verify.pages.text.typography import IS, join_and, power_of_h, start, step, whole
from verify.scenes.results.kept import KeptResult, StructureResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.run import RunResult

_LONGEST = 70  # characters of a formula in the table; results.json has all of it

_SAME = ("area", "volume", "energy")  # names that are labels


@dataclass(frozen=True)
class StructureRow:
    """The details of one structure: `mark` in the table of schemes, `accumulated` over runs.

    `leading` and `potential` are empty if they are too long for a table.
    """

    proof: StructureResult
    label: str
    mark: str
    leading: str
    potential: str
    accumulated: Markup


@dataclass(frozen=True)
class SchemeRows:
    """The structures of one scheme; `where` it all holds, if that is the same for each."""

    result: KeptResult
    rows: tuple[StructureRow, ...]
    where: str


@dataclass(frozen=True)
class KeptView:
    """The `structures` by their labels, the schemes, and the plots of H − H₀."""

    structures: tuple[str, ...]
    schemes: tuple[SchemeRows, ...]
    plots: tuple[Plot, ...]


def _view(scene: SceneResult, anchor: str) -> KeptView | None:
    if not scene.keeps:
        return None
    return KeptView(
        structures=tuple(_label(x).partition(":")[0] for x in scene.keeps[0].keeps),
        schemes=tuple(_rows_of(result, scene.runs) for result in scene.keeps),
        plots=tuple(_energy_plots(scene, anchor)),
    )


def _rows_of(result: KeptResult, runs: Sequence[RunResult]) -> SchemeRows:
    own_runs = [run for run in runs if run.scheme == result.scheme]
    rows = tuple(_row(proof, own_runs) for proof in result.keeps)
    domains = {proof.where for proof in result.keeps}
    return SchemeRows(result, rows, domains.pop() if len(domains) == 1 else "")


def _row(proof: StructureResult, runs: Sequence[RunResult]) -> StructureRow:
    mark = "✓" if proof.exact else "?" if proof.order is None else power_of_h(proof.order)
    leading, potential = (
        text if text and len(text) <= _LONGEST else "" for text in (proof.leading, proof.potential)
    )
    accumulated = _accumulation(proof, runs)
    return StructureRow(proof, _label(proof), mark, leading, potential, accumulated)


def _label(proof: StructureResult) -> str:
    """Return the label, with the kind of a structure that is given by its formula alone."""
    if proof.structure == "symplectic" and not proof.label.startswith("the "):
        return f"the form {proof.label}"
    is_formula = proof.label == proof.structure and proof.label not in _SAME
    return f"the integral {proof.label}" if is_formula else proof.label


def _accumulation(proof: StructureResult, runs: Sequence[RunResult]) -> Markup:
    """Return what the defects of all steps make of the observable, in the run where it is most."""
    if proof.exact:
        return Markup("0, proved")
    name = proof.observable
    measured = [run for run in runs if name in run.values]
    if not measured:
        return Markup("–")
    run = max(measured, key=lambda each: abs(Fraction(each.values[name].value)))
    value, label = run.values[name], _label_of_run(name)
    how = "proved" if name in run.exact else run.error_kind
    place = f"h{IS}{step(run.step_size)}, N{IS}{whole(run.steps)}: {how}"
    return Markup('{}: {} <span class="bound">{}</span>').format(label, known_digits(value), place)


def _label_of_run(name: str) -> str:
    """Return the observable's label; that of an integral without its formula, which stands by."""
    observable = observables.find(name)
    return observable.label.partition(",")[0] if observable else name


def _energy_plots(scene: SceneResult, anchor: str) -> Iterator[Plot]:
    """Yield a plot for each series of the scene, with a panel for each scheme."""
    runs = [run for run in scene.series if any(point.energy for point in run.series)]
    groups = by_key(runs, lambda run: (run.step_size, run.steps, run.arithmetic, start(run)))
    for index, ((size, *_, start_text), group) in enumerate(groups.items()):
        yield _plot(group, f"h = {size} from {start_text}", f"energy-{index}-of-{anchor}")


def _plot(runs: Sequence[RunResult], label: str, name: str) -> Plot:
    from verify.pages.figures import energy_figure as figure

    steps = max(point.last - point.first + 1 for run in runs for point in run.series)
    greatest = [
        f"{known_digits(run.values['energy_error_max'])} of {run.scheme_title}"
        for run in runs
        if "energy_error_max" in run.values
    ]
    every = "each step" if steps == 1 else f"every {whole(steps)} steps"
    sentences = [
        f"A point after {every}; each panel has its own scale.",
        f"The greatest |H − H₀| after any step: {join_and(greatest)}." if greatest else "",
        describe_runs(runs),
    ]
    return captioned_plot(
        lambda: figure.draw_energy(runs),
        name=name,
        lead=f"H − H₀ over time, {label}",
        caption=" ".join(filter(None, sentences)),
    )


SECTION = ReportSection(
    order=5,
    title="What is kept",
    anchor="kept",
    view=_view,
    pictures=lambda view: [Picture((5,), plot) for plot in view.plots],
    terms=lambda views: (
        legend.terms_of("kept")
        | (legend.terms_of_runs() if any(view.plots for view in views) else {})
    ),
)
