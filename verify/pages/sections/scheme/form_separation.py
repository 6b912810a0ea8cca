"""Truncation against rounding in W as the page shows it, in n degrees of freedom."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from markupsafe import Markup

from verify.pages.figures.captioned_plot import few, few_digits
from verify.pages.sections.rows import Group, Row, groups_of_grids, told_of_points
from verify.pages.sections.section import Section
from verify.pages.sections.separation_finding import computed
from verify.pages.text import words
from verify.pages.text.prose import prose
from verify.pages.text.typography import listed, start, step, whole
from verify.scenes.results.proof import ProofResult
from verify.scenes.results.report import SceneResult
from verify.scenes.results.separation import WAYS
from verify.scenes.results.separation_in_degrees import (
    FORM_ROUNDING,
    SeparationGridInDegrees,
    SeparationInDegrees,
)


@dataclass(frozen=True)
class FormSeparationView:
    finding: tuple[Markup, ...]  # what W and the tangent map did, of each step size
    kinds: tuple[str, ...]  # of rounding
    parts: tuple[Group, ...]
    motions: tuple[Group, ...]
    crossed: tuple[str, ...]
    count: int
    told: str  # which of them are shown, where not all are
    computed: str


def _view(scene: SceneResult, proof: ProofResult, _: str) -> FormSeparationView | None:
    own, beside = (
        [g for g in grids if g.points and g.points[0].scheme == proof.scheme]
        for grids in (scene.form_separations, scene.form_crossovers)
    )
    rows = [point for grid in (*own, *beside) for point in grid.points]
    if not rows:
        return None
    every = [*own, *beside]
    return FormSeparationView(
        finding=tuple(_findings(rows)),
        kinds=next((x.plain.parts.of_rounding for x in rows if x.plain), FORM_ROUNDING),
        parts=tuple(groups_of_grids(every, _parts_row)),
        motions=tuple(groups_of_grids(every, _motion_row)),
        crossed=tuple(_crossed(grid) for grid in beside),
        count=len(rows),
        told=told_of_points(rows),
        computed=computed(rows, listed),
    )


def _findings(rows: Sequence[SeparationInDegrees]) -> Iterator[Markup]:
    """What is said of the longest of the runs: how W grew, and how the motion did."""
    held = [point for point in rows if point.tangent]
    if not held:
        yield Markup("No run could be separated; the table says why.")
        return
    longest = max(held, key=lambda point: Fraction(point.step_size) * point.steps)
    assert longest.tangent is not None  # noqa: S101 - chosen so
    where = Markup("Over T = {}, h = {}: ").format(longest.tangent.time, step(longest.step_size))
    yield where + prose(longest.tangent.meaning) + Markup(".")


def _crossed(grid: SeparationGridInDegrees) -> str:
    ways = [(label, getattr(grid, way)) for way, label in WAYS.items()]
    found = (f"{label}: {f'h* ≈ {x.step_size}' if x.step_size else x.reason}" for label, x in ways)
    return f"Rounding overtakes truncation, from {start(grid.points[0])}: {listed(found)}."


# -- tables ---------------------------------------------------------------------------------------


def _parts_row(point: SeparationInDegrees) -> Row:
    h, steps = step(point.step_size), whole(point.steps)
    plain, closed = point.plain, point.closed_form
    if plain is None or closed is None:
        return Row(h, (steps,), point.reason or point.status)
    parts = plain.parts
    sizes = {name: abs(getattr(parts, name).largest) for name in parts.of_rounding}
    greatest = max(sizes, key=lambda name: sizes[name].exact)
    own = (few_digits(x, strong=name == greatest) for name, x in sizes.items())
    wholes = (few_digits(abs(x.largest)) for x in (parts.truncation, parts.total))
    return Row(h, (steps, *wholes, *own, few_digits(abs(closed.parts.total.largest))))


def _motion_row(point: SeparationInDegrees) -> Row | None:
    found, closed = point.tangent, point.closed_form
    if found is None or closed is None:
        return None
    law = closed.law if any(map(any, closed.parts.w_working.exact)) else None
    cells = (
        whole(point.steps),
        few(found.norm_squared),
        few(found.areas),
        few(found.finite_time_lyapunov),
        f"exponential, {_CAUSES[found.cause]}" if found.cause else found.motion,
        _law(law.exponent, law.name) if law else "0",
    )
    return Row(step(point.step_size), cells)


def _law(exponent: str | None, name: str) -> str:
    return name if exponent is None else f"{name} ({exponent})"


_CAUSES = {"motion": "the motion’s", "scheme": "the scheme’s", "undecided": "whose, undecided"}
SECTION = Section(
    order=71,
    title="Truncation against rounding in W",
    view=_view,
    terms=lambda _: {"W": words.OF_FORM["W"]} | words.SEPARATED_FORM | words.RAN,
)
