"""A report as one self-contained page, with the same results as JSON beside it.

This module makes the view of a report that the templates show, for the page and for the Markdown
that is made from it. Nothing is computed anew.
"""

import base64
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, cached_property, partial
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from verify.files import write_atomically
from verify.hamiltonians.coordinates import coordinates_of
from verify.pages.figures.captioned_plot import Plot
from verify.pages.first_screen import FirstScreen, first_screen
from verify.pages.sections import page as of_page
from verify.pages.sections import page_contents
from verify.pages.sections import scene as of_scene
from verify.pages.sections.section import SectionPlace, VisibleSection, select_sections, terms, walk
from verify.pages.text import legend, mathml, prose_markup, typography
from verify.pages.text.legend import SIGNS
from verify.pages.text.typography import join_and, whole
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report, SceneResult


@dataclass(frozen=True)
class PageView(page_contents.PageContents):
    """The page's view: the first screen, the sections after it, and the terms that they need."""

    first: FirstScreen
    sections: tuple[VisibleSection, ...]
    terms: Mapping[str, Markup]

    def groups_on(self, scene_anchor: str) -> list[page_contents.ClaimGroup]:
        """Return the groups of claims that have a claim on this scene."""
        return [g for g in self.groups if any(c.scene_anchor == scene_anchor for c in g.claims)]

    def keeping_place(self, plot: Plot) -> SectionPlace | None:
        """Return the only place where the plot stands, or None if no section keeps it."""
        return next((place for kept_plot, place in self._kept_plots if kept_plot is plot), None)

    @cached_property
    def _kept_plots(self) -> Sequence[tuple[Plot, SectionPlace]]:
        return [kept_plot for s in walk(self.sections) for kept_plot in s.section.keeps(s.view)]


def page_view(report: Report) -> PageView:
    """Return the view of the report; pictures are drawn here."""
    contents = _contents_of(report)
    sections = select_sections(of_page.FILES, SectionPlace("", ""), contents)
    return PageView(
        **vars(contents),
        first=first_screen(report, contents.claims, sections),
        sections=sections,
        terms=legend.terms_of("page") | terms(sections),
    )


# -- claims and scenes with their places -----------------------------------------------------------


def _contents_of(report: Report) -> page_contents.PageContents:
    """Return the report's claims and scenes with their places, which all sections share."""
    anchors = page_contents.Anchors()
    scene_anchors = [anchors.take("system", scene.name) for scene in report.scenes]
    claims = _build_claim_views(report, scene_anchors, anchors)
    scenes = tuple(
        _build_scene_view(scene, anchor)
        for scene, anchor in zip(report.scenes, scene_anchors, strict=True)
    )
    return page_contents.PageContents(
        report, anchors, claims, tuple(page_contents.groups(claims, anchors)), scenes
    )


def _build_claim_views(
    report: Report, scene_anchors: Sequence[str], anchors: page_contents.Anchors
) -> tuple[page_contents.ClaimView, ...]:
    scenes = {
        s.name: (anchor, s.title) for s, anchor in zip(report.scenes, scene_anchors, strict=True)
    }
    statements = {
        reading: statement_result
        for statement_result in report.statements
        for reading in statement_result.readings
    }
    views: list[page_contents.ClaimView] = []
    for result in _most_favourable_first(report.claims):
        anchor, statement = anchors.take("claim", result.id), statements.get(result.id)
        is_later_reading = (
            statement is not None and bool(views) and views[-1].statement is statement
        )
        scene = scenes.get(result.scene, ("", ""))
        claim = page_contents.ClaimView(
            result, anchor, *scene, statement=statement, is_later_reading=is_later_reading
        )
        if claim.is_table:
            claim = replace(
                claim, plot=page_contents.plot_printed_table(claim, name=f"table-of-{anchor}")
            )
        views.append(claim)
    return tuple(views)


def _most_favourable_first(claims: Sequence[ClaimResult]) -> list[ClaimResult]:
    """Return the claims with the readings of a statement together, those that hold first."""
    # The sort key: the place of the statement's first reading, then verdict, standing and own
    # place.
    first_places: dict[str, int] = {}
    ranks = []
    for index, claim in enumerate(claims):
        first_place = (
            first_places.setdefault(claim.statement_id, index) if claim.statement_id else index
        )
        ranks.append((first_place, not claim.verdict.holds, claim.standing != "fair", index))
    return [claims[rank[-1]] for rank in sorted(ranks)]


def _build_scene_view(scene: SceneResult, anchor: str) -> page_contents.SceneView:
    names = mathml.free_names(scene.hamiltonian)
    decided_names = {*coordinates_of(names), *scene.parameters, "t"}
    for name in names:  # u_dot on the left of an equation without an H
        if name.endswith("_dot"):
            decided_names |= {name, name.removesuffix("_dot")}
    return page_contents.SceneView(
        result=scene,
        anchor=anchor,
        symbols=tuple(n for n in names if n not in decided_names),
        rounding_note=_describe_floors(scene),
        sections=select_sections(of_scene.FILES, SectionPlace(anchor, scene.title), scene, anchor),
    )


def _describe_floors(scene: SceneResult) -> str:
    """Return a sentence on the step sizes that do not divide the time, with their N; else ""."""
    if scene.time is None:
        return ""
    time = Fraction(scene.time)
    steps_by_size = {
        r.step_size: r.steps
        for r in (*scene.runs, *scene.series)
        # Runs with their own number of steps are not concerned.
        if time // Fraction(r.step_size) == r.steps and r.steps * Fraction(r.step_size) != time
    }
    if not steps_by_size:
        return ""
    listing = join_and(f"h = {h} gives N = {whole(n)}" for h, n in steps_by_size.items())
    return f"Where T/h is not a whole number, N is T/h rounded down: {listing}."


TEMPLATES = Path(__file__).parent / "templates"
FONT = Path(__file__).parent / "fonts" / "formulas.woff"
_FILTERS = (
    prose_markup.prose, prose_markup.prose_with_backticks, prose_markup.sentence,
    prose_markup.cell, prose_markup.notation,
    mathml.name, mathml.formula, mathml.plain, typography.exact, typography.number,
    typography.whole, typography.join_and, typography.every, typography.power_of_h,
    typography.start, typography.step,
)  # fmt: skip


def environment(render_plot: Callable[[Plot], Markup] = lambda plot: plot.svg) -> Environment:
    """Return the templates' environment; `render_plot` sets a picture as the format needs it."""
    templates = Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters.update({text_filter.__name__: text_filter for text_filter in _FILTERS})
    equations = {
        "equation": lambda left, text: mathml.equation(mathml.NAMED[left], text),
        "hamiltonian": mathml.hamiltonian,
        "jacobian": partial(mathml.matrix, mathml.NAMED["J"]),
        "order_equation": mathml.order_equation,
    }
    templates.globals.update(equations, signs=SIGNS, render_plot=render_plot)
    return templates


PAGE, DATA = "index.html", "results.json"


def write(report: Report, folder: Path, *, full: bool = False) -> Path:
    """Write `index.html` and `results.json` into the folder and return the path of the page."""
    page = folder / PAGE
    content = render(report, full=full)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    write_atomically(page, content)
    return page


def render(report: Report, *, full: bool = False) -> str:
    """Return the page as text; with `full`, all its folded parts are open, for paper."""
    # The page's policy names its one script by its digest: no other may run.
    script = (TEMPLATES / "page.js").read_text(encoding="utf-8")
    template = _environment().get_template("page.html")
    page = template.render(
        page=page_view(report),
        full=full,
        script=Markup(script),  # noqa: S704 - our own
        digest=_base64(hashlib.sha256(script.encode()).digest()),
        font=_base64(FONT.read_bytes()),
    )
    return page.replace("<details", "<details open") if full else page


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode()


@cache
def _environment() -> Environment:
    return environment()
