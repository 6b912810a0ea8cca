"""The stability of a scene's schemes: sentences, pictures, tables."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from verify.arithmetic.exact import plain, short
from verify.pages.figures.captioned_plot import Plot, captioned_plot
from verify.pages.sections.section import Picture, ReportSection
from verify.pages.sections.table_rows import TableRow, by_key, describe_excerpt, select_members
from verify.pages.text.legend import counts_of
from verify.pages.text.prose_markup import prose
from verify.pages.text.typography import coordinates, join_and, number, step, whole
from verify.scenes.results import stability
from verify.scenes.results.report import SceneResult

MEANINGS: dict[stability.Kind, str] = {
    "stable": "stays within the exact orbit’s bounds, and no drift of its energy is seen",
    "drifts": "stays within them, but its energy moves on in one direction",
    "unstable: scheme": "leaves them with 40 and with 80 digits too: the scheme’s doing",
    "unstable: arithmetic": "parts from the same scheme in high precision: float64’s rounding",
    "escapes": "the exact solution itself leaves",
    "overflow": "a number is beyond float64’s range, and 53 bits with wider exponents stay",
    "underflow": "numbers vanish in float64 that wider exponents keep",
    "sensitive": "the exact motion itself parts from its neighbours exponentially",
    "undecided": "no two precisions agree, or the run is too long for high precision",
}


@dataclass(frozen=True)
class StabilityView:
    """The view of a scene's stability.

    `kinds`: the verdicts that occur; `bound`: a phrase on the time over which the motion with the
    largest steps is bounded; `runs`: the visible ones of `count` runs, each with its name and step
    size; `excerpt`: a sentence on these; `plots`: each with the number of kinds that it shows.
    """

    finding: tuple[str, ...]
    kinds: tuple[stability.Kind, ...]
    runs: tuple[tuple[str, str, stability.StabilityResult], ...]
    count: int
    excerpt: str
    largest: tuple[TableRow, ...]
    bound: str
    plots: tuple[tuple[int, Plot], ...]


def _view(scene: SceneResult, anchor: str) -> StabilityView | None:
    runs, steps, maps = scene.stability, scene.largest_steps, scene.stability_maps
    if not (runs or steps or maps):
        return None
    occurring = {run.kind for run in runs} | {
        kind for stability_map in maps for kind in stability_map.counted()
    }
    (visible,) = select_members([runs], _is_not_stable)
    return StabilityView(
        finding=tuple(_finding(runs, steps)),
        kinds=tuple(kind for kind in stability.KINDS if kind in occurring),
        runs=tuple((_name(run), step(short(Fraction(run.step_size))), run) for run in visible),
        count=len(runs),
        excerpt=describe_excerpt(len(runs), len(visible), sum(map(_is_not_stable, runs))),
        largest=tuple(map(_row_of_largest_step, steps)),
        bound=_describe_time(steps),
        plots=tuple(_plots(maps, anchor)),
    )


def _is_not_stable(run: stability.StabilityResult) -> bool:
    return run.kind != "stable"


def _finding(
    runs: Sequence[stability.StabilityResult], steps: Sequence[stability.LargestStepResult]
) -> Iterator[str]:
    if runs:
        counts = Counter(run.kind for run in runs)
        yield f"Of {whole(len(runs))} runs: {counts_of(counts)}."
    drifting = sorted(
        (run for run in runs if run.rate), key=lambda run: -abs(Fraction(run.rate or 0))
    )
    if drifting:
        worst = drifting[0]
        yield (
            f"The fastest drift is that of {worst.scheme_title} at h = {step(worst.step_size)}: "
            f"its energy changes by {number(worst.rate or '0')} of its own scale in a unit of time."
        )
    comparable = [s for s in steps if s.bounded and s.linear and Fraction(s.linear) > 0]
    if comparable:
        ratios = [Fraction(s.bounded or 0) / Fraction(s.linear or 1) for s in comparable]
        low, high = (f"{float(x):.2g}" for x in (min(ratios), max(ratios)))
        yield (
            f"Where linear theory allows steps at all, the largest step with bounded motion is "
            f"{low} to {high} times the one that it predicts from where the orbit is stiffest."
        )
    never = [s.scheme_title for s in steps if s.linear and Fraction(s.linear) == 0 and s.bounded]
    if never:
        yield (
            f"For {join_and(never)} it allows none, and what is bounded over this time is so for "
            "this time only."
        )


def _name(run: stability.StabilityResult) -> str:
    """Return the run's id without scene, scheme and step size: the section and initial value."""
    _, *parts = run.id.split("/")
    implied = (run.scheme_title, f"h={short(Fraction(run.step_size))}")
    return ", ".join(part for part in parts if part not in implied)


def _row_of_largest_step(result: stability.LargestStepResult) -> TableRow:
    linear, ratio = "no limit", "–"
    if result.linear is not None:
        linear = _four_digits(result.linear) if Fraction(result.linear) else "none is stable"
        if result.bounded and Fraction(result.linear):
            ratio = f"{float(Fraction(result.bounded) / Fraction(result.linear)):.3f}"
    measured_step = _four_digits(result.bounded) if result.bounded else prose(result.detail)
    return TableRow(
        f"{result.scheme_title}{_describe_requirements(result)}", (measured_step, linear, ratio)
    )


def _describe_requirements(result: stability.LargestStepResult) -> str:
    """Return the limits on the motion besides that it stays bounded, after a comma; "" for none."""
    requirements = (("energy error", result.energy_error), ("|W|", result.symplectic_defect))
    limits = [f"{quantity} ≤ {number(limit)}" for quantity, limit in requirements if limit]
    return f", {' and '.join(limits)}" if limits else ""


def _four_digits(x: str) -> str:
    return number(plain(Fraction(x), 4))


def _describe_time(steps: Sequence[stability.LargestStepResult]) -> str:
    times = dict.fromkeys(number(s.time) for s in steps)
    return f"until t = {join_and(list(times))}" if times else ""


def _plots(maps: Sequence[stability.StabilityMapResult], anchor: str) -> Iterator[tuple[int, Plot]]:
    """Yield a plot for the maps of all schemes over the same steps and values.

    The drawing, and with it matplotlib, is imported only if there is a map.
    """
    groups = by_key(maps, lambda m: (m.parameter, m.values, m.step_sizes, m.steps, m.q, m.p))
    for index, group in enumerate(groups.values()):
        from verify.pages.figures.kind_map_figure import draw_planes

        names = join_and(stability_map.scheme_title for stability_map in group)
        lead = f"Stability of {names} over the step size h and {group[0].parameter}"
        counts = "; ".join(f"{m.scheme_title}: {counts_of(m.counted())}" for m in group)
        plot = captioned_plot(
            lambda group=group: draw_planes(group),  # type: ignore[misc]
            name=f"stability-{index}-of-{anchor}",
            lead=lead,
            label=f"{lead}. {counts}.",
            caption=_caption(group, counts),
        )
        yield len({kind for stability_map in group for kind in stability_map.counted()}), plot


def _caption(maps: Sequence[stability.StabilityMapResult], counts: str) -> str:
    """Return the caption; it has the counts of a single map, but not those of several."""
    first_map = maps[0]
    limit_note = ""
    if any(_is_positive(h) for m in maps for h in m.linear):
        limit_note = (
            " The line is where h times the orbit’s greatest frequency reaches the limit of linear "
            "theory."
        )
    never = [m.scheme_title for m in maps if any(m.linear) and not any(map(_is_positive, m.linear))]
    if never:
        limit_note += f" For {join_and(never)} linear theory has no stable step."
    return (
        f"Each mark is a run of {whole(first_map.steps)} steps from "
        f"q = {coordinates(first_map.q)}, p = {coordinates(first_map.p)}.{limit_note}"
        + f" {counts}."
        * (len(maps) == 1)
    )


def _is_positive(step_size: str | None) -> bool:
    return bool(step_size) and Fraction(step_size or 0) > 0


def _pictures(view: StabilityView) -> Iterator[Picture]:
    """Yield the pictures; the one with the most kinds of run ranks first."""
    for kinds, plot in view.plots:
        yield Picture((1, -kinds), plot)


def _terms(views: Sequence[StabilityView]) -> dict[str, Markup]:
    """Return the meanings of the verdicts that occur."""
    occurring = {kind for view in views for kind in view.kinds}
    items = (
        Markup("<div><dt>{}</dt><dd>{}</dd></div>").format(kind, meaning)
        for kind, meaning in MEANINGS.items()
        if kind in occurring
    )
    definitions = Markup('<dl class="kinds" id="kinds">{}</dl>').format(Markup("\n").join(items))
    return {"Verdicts on runs": definitions} if occurring else {}


SECTION = ReportSection(
    order=30, title="Stability", anchor="stability", view=_view, pictures=_pictures, terms=_terms
)
