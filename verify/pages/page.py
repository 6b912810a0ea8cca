"""A Report → one self-contained page, and the same results as JSON beside it.

What the templates are set with, for the page and for the Markdown that is made of them.

Report → what the page's templates show. Nothing is computed anew.
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
from verify.pages.sections import scene as of_scene
from verify.pages.sections import scheme_plots
from verify.pages.sections.claim_view import Anchors, ClaimGroup, ClaimView, groups
from verify.pages.sections.given import Given, SceneView
from verify.pages.sections.section import Place, Shown, shown, terms, walk
from verify.pages.text import mathml, notation, prose, typography, words
from verify.pages.text.signs import SIGNS
from verify.pages.text.typography import listed, whole
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report, SceneResult


@dataclass(frozen=True)
class PageView(Given):
    """The first screen, and after it the sections of the page with the terms that they need."""

    first: FirstScreen
    sections: tuple[Shown, ...]
    terms: Mapping[str, Markup]

    def groups_on(self, scene_anchor: str) -> list[ClaimGroup]:
        """Those with a claim on this scene."""
        return [g for g in self.groups if any(c.scene_anchor == scene_anchor for c in g.claims)]

    def kept_at(self, plot: Plot) -> Place | None:
        """The one place where it stands, if there is a section that keeps it."""
        return next((place for kept, place in self._kept if kept is plot), None)

    @cached_property
    def _kept(self) -> Sequence[tuple[Plot, Place]]:
        return [each for s in walk(self.sections) for each in s.section.keeps(s.view)]


def page_view(report: Report) -> PageView:
    """All of it; pictures are drawn here."""
    own = _given(report)
    sections = shown(of_page.FILES, Place("", ""), own)
    return PageView(
        **vars(own),
        first=first_screen(report, own.claims, sections),
        sections=sections,
        terms=words.ALWAYS | terms(sections),
    )


# -- claims and scenes with their places -----------------------------------------------------------


def _given(report: Report) -> Given:
    """The report's claims and scenes, as all sections of the page speak of them."""
    anchors = Anchors()
    own = [anchors.take("system", scene.name) for scene in report.scenes]
    claims = _claims(report, own, anchors)
    scenes = tuple(_scene(scene, at) for scene, at in zip(report.scenes, own, strict=True))
    return Given(report, anchors, claims, tuple(groups(claims, anchors)), scenes)


def _claims(report: Report, own: Sequence[str], anchors: Anchors) -> tuple[ClaimView, ...]:
    scenes = {s.name: (anchor, s.title) for s, anchor in zip(report.scenes, own, strict=True)}
    statements = {reading: each for each in report.statements for reading in each.readings}
    found: list[ClaimView] = []
    for result in _most_favourable_first(report.claims):
        anchor, of = anchors.take("claim", result.id), statements.get(result.id)
        again = of is not None and bool(found) and found[-1].of is of
        scene = scenes.get(result.scene, ("", ""))
        claim = ClaimView(result, anchor, *scene, of=of, again=again)
        if claim.is_table:
            claim = replace(claim, plot=scheme_plots.table(claim, name=f"table-of-{anchor}"))
        found.append(claim)
    return tuple(found)


def _most_favourable_first(claims: Sequence[ClaimResult]) -> list[ClaimResult]:
    """The readings of a statement where its first one stands, those that hold before the others."""
    first: dict[str, int] = {}
    ranks = []
    for place, claim in enumerate(claims):
        at = first.setdefault(claim.statement_id, place) if claim.statement_id else place
        ranks.append((at, not claim.verdict.holds, claim.standing != "fair", place))
    return [claims[rank[-1]] for rank in sorted(ranks)]


def _scene(scene: SceneResult, anchor: str) -> SceneView:
    names = mathml.free_names(scene.hamiltonian)
    known = {*coordinates_of(names), *scene.parameters, "t"}
    return SceneView(
        result=scene,
        anchor=anchor,
        symbols=tuple(n for n in names if n not in known),
        floors=_floors(scene),
        sections=shown(of_scene.FILES, Place(anchor, scene.title), scene, anchor),
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


TEMPLATES = Path(__file__).parent / "templates"
_FILTERS = (
    prose.prose, prose.quoted, prose.sentence, prose.cell, notation.notation, mathml.name,
    mathml.formula, mathml.plain, typography.exact, typography.number,
    typography.whole, typography.listed, typography.every, typography.power_of_h,
    typography.start, typography.step,
)  # fmt: skip


def environment(drawn: Callable[[Plot], Markup] = lambda plot: plot.svg) -> Environment:
    """`drawn`: a picture as the format has it."""
    made = Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters.update({each.__name__: each for each in _FILTERS})
    own = {
        "equation": lambda left, text: mathml.equation(mathml.NAMED[left], text),
        "hamiltonian": mathml.hamiltonian,
        "jacobian": partial(mathml.matrix, mathml.NAMED["J"]),
        "order_equation": mathml.order_equation,
    }
    made.globals.update(own, signs=SIGNS, drawn=drawn)
    return made


PAGE, DATA = "index.html", "results.json"


def write(report: Report, folder: Path, *, full: bool = False) -> Path:
    """Write `index.html` and `results.json` into the folder; the path of the page."""
    page = folder / PAGE
    content = render(report, full=full)
    write_atomically(folder / DATA, report.model_dump_json(indent=1))
    write_atomically(page, content)
    return page


def render(report: Report, *, full: bool = False) -> str:
    """The whole page as text; `full`: with all that it folds open, on paper too."""
    # The page's policy names its one script by its digest: no other may run.
    script = (TEMPLATES / "page.js").read_text(encoding="utf-8")
    template = _environment().get_template("page.html")
    page = template.render(
        page=page_view(report),
        full=full,
        script=Markup(script),  # noqa: S704 - our own
        digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
    )
    return page.replace("<details", "<details open") if full else page


@cache
def _environment() -> Environment:
    return environment()
