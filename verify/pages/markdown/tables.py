"""The views' tables as Markdown: one table an initial value or a scheme, since a Markdown table has
no rows of headings inside."""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from verify.pages.markdown.from_markup import Markdown, escaped, table
from verify.pages.sections.claim_view import ClaimView
from verify.pages.sections.run_table import RunTable
from verify.pages.text.typography import cell, sentence
from verify.scenes.results.claim import CriterionResult
from verify.verdict import Verdict

if TYPE_CHECKING:
    from verify.pages.sections.flow_view import Cell, RegionView
    from verify.pages.sections.growth_view import GrowthView
    from verify.pages.sections.separation_view import SeparationView
    from verify.pages.sections.stability_view import StabilityView
    from verify.pages.sections.work_precision_view import WorkPrecisionView


def criteria(
    found: Sequence[tuple[CriterionResult, str]], badge: Callable[[Verdict], Markdown]
) -> list[tuple[object, ...]]:
    return [(f"{c.number}. {asked}", badge(c.verdict), sentence(c.evidence)) for c, asked in found]


def details(claim: ClaimView) -> Markdown:
    """The numbers behind a claim: the first row is the head."""
    head, *rows = claim.result.details
    widest = max(len(row) for row in claim.result.details)
    heads = [*map(cell, head), *[""] * (widest - len(head))]
    return table(heads, [[cell(entry) for entry in row] for row in rows], "l")


def printed_and_computed(claim: ClaimView) -> Markdown:
    """A printed table: each printed number beside those computed for it."""
    heads = ("h", "printed", *(cell(row[0]) for row in claim.computed))
    return table(heads, [(h, *map(cell, entries)) for h, entries in claim.by_step_size])


def runs(view: RunTable) -> Markdown:
    heads = ("h", "N", *view.columns)
    return _joined(
        (label, table(heads, [(r.step_size, r.steps, *(r.cells or (r.failure,))) for r in rows]))
        for label, rows in view.groups
    )


def growth_law(view: "GrowthView") -> Markdown:
    heads = ("h", "N", "boundary", "secular", "Λ predicted", "Λ measured", "difference")
    return _joined(
        (f"{g.label} ({g.orbit})", table(heads, [(r.step_size, r.steps, *r.cells) for r in g.rows]))
        for g in view.groups
    )


def separation(view: "SeparationView") -> Markdown:
    heads = ("h", "N", "truncation", "rounding, plain", "input", "trajectory", "determinant",
             "product", "rounding, closed form")  # fmt: skip
    found = []
    for group in view.groups:
        rows: list[Sequence[object]] = []
        for r in group.parts:
            values = (r.failure,) if r.failure else (r.truncation, r.plain, *r.parts, r.closed_form)
            rows.append((r.step_size, r.steps, *values))
        found.append((group.label, table(heads, rows)))
    return _joined(found)


def rounding_growth(view: "SeparationView") -> Markdown:
    heads = ("h", "N", "the plain way", "closed form")
    return _joined(
        (g.label, table(heads, [(r.step_size, r.steps, *r.ways) for r in g.growth]))
        for g in view.groups
        if g.growth
    )


def schemes(view: "WorkPrecisionView") -> Markdown:
    heads = ("scheme", "order claimed", "order of the error", "order of Λ", "operations",
             "gradient", "compilation, s")  # fmt: skip
    return table(heads, [(row.name, *row.cells) for row in view.schemes], "l")


def systems(view: "WorkPrecisionView") -> Markdown:
    heads = ("number system", "digits asked", "certified", "least, s", "median, s", "bound")
    return table(heads, [(row.name, *row.cells) for row in view.systems], "lrrrrl")


def work(view: "WorkPrecisionView") -> Markdown:
    heads = ("h or tolerance", "N", "error", "its rounding part", "energy error", "Λ", "Λ, plain",
             "least, s", "median, s", "limited by")  # fmt: skip
    return _joined(
        (
            f"{group.name}, {group.about} s",
            table(
                heads,
                [
                    (r.label, r.steps, *((r.failure,) if r.failure else (*r.cells, r.limited)))
                    for r in group.rows
                ],
                "rrrrrrrrrl",
            ),
        )
        for group in view.groups
    )


def largest_steps(view: "StabilityView") -> Markdown:
    heads = ("scheme", "measured", "linear theory", "ratio")
    return table(heads, [(r.scheme, r.measured, r.linear, r.ratio) for r in view.largest], "l")


def stability_table(view: "StabilityView") -> Markdown:
    heads = ("case", "scheme", "h", "N", "verdict", "evidence")
    rows = [(r.name, r.scheme, r.step_size, r.steps, r.verdict, r.detail) for r in view.runs]
    return table(heads, rows, "llrrll")


def region_table(view: "RegionView") -> Markdown:
    heads = ("map", "N", "t", "change of area", "mean of Λ", "distance", "arithmetic")
    rows = [
        (r.map, r.steps, r.time, _pair(r.change), _pair(r.mean), _pair(r.distance), r.arithmetic)
        for r in view.rows
    ]
    return table(heads, rows, "lrrrrrl")


def _pair(found: "Cell") -> str:
    return f"{found.value} ± {found.error}" if found.error else found.value


def _joined(parts: Iterable[tuple[str, Markdown]]) -> Markdown:
    return Markdown("\n\n".join(f"<b>{escaped(label)}</b>\n\n{found}" for label, found in parts))
