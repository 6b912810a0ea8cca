"""How stable a scene's schemes are, as the page shows it: sentences, pictures, tables."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from verify.arithmetic.exact import plain, short
from verify.pages.figures.captioned_plot import Plot, plotted
from verify.pages.sections.by_key import by_key
from verify.pages.sections.rows import Row, shown, told
from verify.pages.sections.section import Picture, Section
from verify.pages.text.prose import prose
from verify.pages.text.typography import coordinates, listed, number, step, whole
from verify.pages.text.words import counts_of
from verify.scenes.results.report import SceneResult
from verify.scenes.results.stability import (
    KINDS,
    Kind,
    LargestStepResult,
    StabilityMapResult,
    StabilityResult,
)

MEANINGS: dict[Kind, str] = {
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
    """`kinds`: the verdicts that occur; `bound`: over which time steps are bounded.

    `runs`: those that are shown, each with its name and its step size, `told` which they are of how
    many, `count`. `plots`: each with how many kinds of run it shows.
    """

    finding: tuple[str, ...]
    kinds: tuple[Kind, ...]
    runs: tuple[tuple[str, str, StabilityResult], ...]
    count: int
    told: str
    largest: tuple[Row, ...]
    bound: str
    plots: tuple[tuple[int, Plot], ...]


def _view(scene: SceneResult, anchor: str) -> StabilityView | None:
    runs, steps, maps = scene.stability, scene.largest_steps, scene.stability_maps
    if not (runs or steps or maps):
        return None
    seen = {run.kind for run in runs} | {kind for over in maps for kind in over.counted()}
    (held,) = shown([runs], _unsound)
    return StabilityView(
        finding=tuple(_finding(runs, steps)),
        kinds=tuple(kind for kind in KINDS if kind in seen),
        runs=tuple((_name(run), step(short(Fraction(run.step_size))), run) for run in held),
        count=len(runs),
        told=told(len(runs), len(held), sum(map(_unsound, runs))),
        largest=tuple(map(_largest, steps)),
        bound=_bound(steps),
        plots=tuple(_plots(maps, anchor)),
    )


def _unsound(run: StabilityResult) -> bool:
    return run.kind != "stable"


def _finding(runs: Sequence[StabilityResult], steps: Sequence[LargestStepResult]) -> Iterator[str]:
    if runs:
        counted = Counter(run.kind for run in runs)
        yield f"Of {whole(len(runs))} runs: {counts_of(counted)}."
    drifting = sorted(
        (run for run in runs if run.rate), key=lambda run: -abs(Fraction(run.rate or 0))
    )
    if drifting:
        worst = drifting[0]
        yield (
            f"The fastest drift is that of {worst.scheme} at h = {step(worst.step_size)}: its "
            f"energy changes by {number(worst.rate or '0')} of its own scale in a unit of time."
        )
    beyond = [s for s in steps if s.bounded and s.linear and Fraction(s.linear) > 0]
    if beyond:
        ratios = [Fraction(s.bounded or 0) / Fraction(s.linear or 1) for s in beyond]
        low, high = (f"{float(x):.2g}" for x in (min(ratios), max(ratios)))
        yield (
            f"Where linear theory allows steps at all, the largest step with bounded motion is "
            f"{low} to {high} times the one that it predicts from where the orbit is stiffest."
        )
    never = [s.scheme for s in steps if s.linear and Fraction(s.linear) == 0 and s.bounded]
    if never:
        yield (
            f"For {listed(never)} it allows none, and what is bounded over this time is so for "
            "this time only."
        )


def _name(run: StabilityResult) -> str:
    """What its id says beside the scene, the scheme and the step size: section, initial value."""
    _, *parts = run.id.split("/")
    own = (run.scheme, f"h={short(Fraction(run.step_size))}")
    return ", ".join(part for part in parts if part not in own)


def _largest(found: LargestStepResult) -> Row:
    linear, ratio = "no limit", "–"
    if found.linear is not None:
        linear = _four(found.linear) if Fraction(found.linear) else "none is stable"
        if found.bounded and Fraction(found.linear):
            ratio = f"{float(Fraction(found.bounded) / Fraction(found.linear)):.3f}"
    measured = _four(found.bounded) if found.bounded else prose(found.detail)
    return Row(f"{found.scheme}{_within(found)}", (measured, linear, ratio))


def _within(found: LargestStepResult) -> str:
    """What it had to keep beside its bounds."""
    asked = (("energy error", found.energy_error), ("|W|", found.symplectic_defect))
    said = [f"{what} ≤ {number(most)}" for what, most in asked if most]
    return f", {' and '.join(said)}" if said else ""


def _four(x: str) -> str:
    return number(plain(Fraction(x), 4))


def _bound(steps: Sequence[LargestStepResult]) -> str:
    times = dict.fromkeys(number(s.time) for s in steps)
    return f"until t = {listed(list(times))}" if times else ""


def _plots(maps: Sequence[StabilityMapResult], anchor: str) -> Iterator[tuple[int, Plot]]:
    """One for the maps of all schemes over the same steps and values.

    The drawing, and with it matplotlib, is imported only where there is a map.
    """
    together = by_key(maps, lambda m: (m.parameter, m.values, m.step_sizes, m.steps, m.q, m.p))
    for index, of in enumerate(together.values()):
        from verify.pages.figures.stability_figure import draw_planes

        names = listed(over.scheme for over in of)
        lead = f"Stability of {names} over the step size h and {of[0].parameter}"
        counts = "; ".join(f"{m.scheme}: {counts_of(m.counted())}" for m in of)
        plot = plotted(
            lambda of=of: draw_planes(of),  # type: ignore[misc]
            name=f"stability-{index}-of-{anchor}",
            lead=lead,
            label=f"{lead}. {counts}.",
            caption=_caption(of, counts),
        )
        yield len({kind for over in of for kind in over.counted()}), plot


def _caption(maps: Sequence[StabilityMapResult], counts: str) -> str:
    """What a picture of one map is, with its counts; those of several are in their alternative."""
    over = maps[0]
    limit = ""
    if any(_is_positive(h) for m in maps for h in m.linear):
        limit = (
            " The line is where h times the orbit’s greatest frequency reaches the limit of linear "
            "theory."
        )
    never = [m.scheme for m in maps if any(m.linear) and not any(map(_is_positive, m.linear))]
    if never:
        limit += f" For {listed(never)} linear theory has no stable step."
    return (
        f"Each mark is a run of {whole(over.steps)} steps from q = {coordinates(over.q)}, "
        f"p = {coordinates(over.p)}.{limit}" + f" {counts}." * (len(maps) == 1)
    )


def _is_positive(step_size: str | None) -> bool:
    return bool(step_size) and Fraction(step_size or 0) > 0


def _pictures(view: StabilityView) -> Iterator[Picture]:
    """That with the most kinds of run tells the most."""
    for kinds, plot in view.plots:
        yield Picture((1, -kinds), plot)


def _terms(views: Sequence[StabilityView]) -> dict[str, Markup]:
    """The verdicts on runs that occur."""
    seen = {kind for view in views for kind in view.kinds}
    each = (
        Markup("<div><dt>{}</dt><dd>{}</dd></div>").format(kind, meaning)
        for kind, meaning in MEANINGS.items()
        if kind in seen
    )
    listed = Markup('<dl class="kinds" id="kinds">{}</dl>').format(Markup("\n").join(each))
    return {"Verdicts on runs": listed} if seen else {}


SECTION = Section(
    order=30, title="Stability", anchor="stability", view=_view, pictures=_pictures, terms=_terms
)
