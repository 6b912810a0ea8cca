"""The contents of a page as its sections read them: a report's claims and scenes with their places.

A claim has its anchor and its group; a printed table has a picture of its row.
"""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from verify.pages.figures.captioned_plot import Plot, captioned_plot
from verify.pages.sections.section import Counts, VisibleSection
from verify.pages.sections.table_rows import by_key
from verify.pages.text.typography import is_decimal
from verify.scenes.results.claim import Category, ClaimResult, Standing, StatementResult
from verify.scenes.results.report import Report, SceneResult
from verify.verdict import Verdict

if TYPE_CHECKING:
    from verify.pages.figures.step_size_figures import LogarithmicLine

_NUMBERED = re.compile(r"\d+(?:\.\d+)*(?=\D|$)")
_STANDINGS: dict[Standing, str] = {
    "fair": "",
    "strict": "taken strictly",
    "misprint": "to the letter, a misprint",
    "ours": "ours, not the paper’s",
}
# The verdict whose colour a statement's category has.
COLOURS = {
    Category.AS_MEANT: Verdict.PROVED,
    Category.MISPRINTED: Verdict.ENCLOSED,
    Category.DEPENDS: Verdict.MEASURED,
    Category.REFUTED: Verdict.REFUTED,
    Category.UNDECIDED: Verdict.UNDECIDED,
}
# The printed row in the details of a table's claim begins with this word.
PRINTED_ROW_START = "printed"


@dataclass(frozen=True)
class ClaimView:
    """A claim with its place on the page; `plot`: its table's picture, if it is a table.

    `statement`: the statement that it is a reading of, if statements are counted;
    `is_later_reading`: True if another reading of that statement stands before this one.
    """

    result: ClaimResult
    anchor: str
    scene_anchor: str
    scene_title: str
    plot: Plot | None = None
    statement: StatementResult | None = None
    is_later_reading: bool = False

    @property
    def outcome(self) -> str:
        """The statement's category, for the first of several readings; else ""."""
        if self.statement is None or self.is_later_reading or len(self.statement.readings) == 1:
            return ""
        return f"{len(self.statement.readings)} readings: {self.statement.category}"

    @property
    def tile_word(self) -> str:
        """The verdict, in small letters, of the tile on the first screen that counts the claim."""
        return (COLOURS[self.statement.category] if self.statement else self.result.verdict).lower()

    @property
    def standing(self) -> str:
        """The reading's departure from the printed text; "" for a fair reading."""
        return _STANDINGS[self.result.standing]

    @property
    def checkers(self) -> str:
        """The checkers of its proof, in a word each."""
        return ", ".join(
            dict.fromkeys(re.split("[:,]", checker)[0] for checker in self.result.checked_by)
        )

    @property
    def name(self) -> str:
        """The claim's name on the page."""
        return self.result.source or self.result.id

    @property
    def is_table(self) -> bool:
        details = self.result.details
        return (
            len(details) > 2
            and len(details[0]) > 1
            and all(len(row) == len(details[0]) for row in details)
            and details[1][0].startswith(PRINTED_ROW_START)
            and all(head.startswith("h = ") for head in details[0][1:])
        )

    @property
    def is_table_of_paper(self) -> bool:
        """True for the first reading of a table that the paper prints."""
        return self.is_table and self.result.standing != "ours" and not self.is_later_reading

    @property
    def step_sizes(self) -> list[str]:
        return [head.removeprefix("h = ") for head in self.result.details[0][1:]]

    @property
    def printed_row(self) -> tuple[str, ...]:
        return self.result.details[1][1:]

    @property
    def computed_rows(self) -> tuple[tuple[str, ...], ...]:
        return self.result.details[2:]

    @property
    def by_step_size(self) -> list[tuple[str, tuple[str, ...]]]:
        """Each step size with its printed value and the computed ones, as in `computed_rows`."""
        columns = zip(self.printed_row, *(row[1:] for row in self.computed_rows), strict=True)
        return list(zip(self.step_sizes, columns, strict=True))


@dataclass(frozen=True)
class ClaimGroup:
    """The claims of one section of the paper; `title` is empty if no claim names a section."""

    title: str
    anchor: str
    claims: tuple[ClaimView, ...]
    counts: Counts


class Anchors:
    """Ids that are unique on the page and safe in a link, whatever the names are."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def take(self, kind: str, name: str) -> str:
        slug = re.sub(r"[^A-Za-z0-9_.-]+", "-", name).strip("-") or "unnamed"
        anchor, count = f"{kind}-{slug}", 1
        # Different names can have the same slug.
        while anchor in self._taken:
            count += 1
            anchor = f"{kind}-{slug}-{count}"
        self._taken.add(anchor)
        return anchor


# -- the sections of the paper --------------------------------------------------------------------


def groups(claims: Sequence[ClaimView], anchors: Anchors) -> list[ClaimGroup]:
    """Return the claims by section, in the order of section numbers, those without one last."""
    by_section = by_key(claims, lambda claim: claim.result.section)
    claim_groups = []
    for section in sorted(by_section, key=_place):
        section_claims = by_section[section]
        title = section or ("Other claims" if len(by_section) > 1 else "")
        verdict_counts = Counter(c.result.verdict for c in section_claims)
        counts = tuple((v, verdict_counts[v]) for v in Verdict if verdict_counts[v])
        claim_groups.append(
            ClaimGroup(
                title, anchors.take("section", title or "all"), tuple(section_claims), counts
            )
        )
    return claim_groups


def _place(section: str) -> tuple[int, list[int]]:
    """Return a key that sorts 4.2 before 4.10, then sections without a number, then none."""
    if match := _NUMBERED.match(section):
        return 0, [int(n) for n in match[0].split(".")]
    return (1 if section else 2), []


# -- printed tables -------------------------------------------------------------------------------


def plot_printed_table(claim: ClaimView, *, name: str) -> Plot | None:
    """Plot lg MSE as printed and as computed; None if fewer than two step sizes can be drawn."""
    from verify.pages.figures import step_size_figures

    printed, lines = rows_of(claim)
    if len(printed.points) < 2 or not lines:
        return None
    return captioned_plot(
        lambda: step_size_figures.draw_printed_against_computed(lines, printed),
        name=name,
        lead=f"{claim.result.source}: lg MSE against the step size h, printed and computed",
        caption=_describe_gap(printed, lines),
    )


def rows_of(claim: ClaimView) -> "tuple[LogarithmicLine, list[LogarithmicLine]]":
    """Return the printed row, and the computed rows with two step sizes or more."""
    from verify.pages.figures import step_size_figures

    def line(label: str, cells: Sequence[str]) -> "LogarithmicLine":
        points = [
            (h, float(cell))
            for h, cell in zip(claim.step_sizes, cells, strict=True)
            if is_decimal(cell)
        ]
        return step_size_figures.LogarithmicLine(label.replace("-", "−"), tuple(points))

    computed = [line(row[0], row[1:]) for row in claim.computed_rows]
    printed = line(f"printed: {claim.result.source}", claim.printed_row)
    return printed, [line for line in computed if len(line.points) > 1]


def _describe_gap(printed: "LogarithmicLine", lines: Sequence["LogarithmicLine"]) -> str:
    height_by_size = dict(printed.points)
    gaps = [height_by_size[h] - y for line in lines for h, y in line.points if h in height_by_size]
    low, high = min(gaps), max(gaps)
    row = "The printed row (thick) is one row for all initial values"
    if low > 0 or high < 0:
        side = "below" if low > 0 else "above"
        least, most = sorted((abs(low), abs(high)))
        return f"{row}; what was computed lies {least:.1f} to {most:.1f} decades {side} it."
    return f"{row}; what was computed differs from it by up to {max(-low, high):.1f} decades."


# -- all of it ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SceneView:
    """A scene with its place on the page."""

    result: SceneResult
    anchor: str
    symbols: tuple[str, ...]  # parameters without a value
    rounding_note: str  # a sentence on the step sizes that do not divide the time
    sections: tuple[VisibleSection, ...]


@dataclass(frozen=True)
class PageContents:
    """A report with its claims, groups and scenes; `anchors` holds those in use already."""

    report: Report
    anchors: Anchors
    claims: tuple[ClaimView, ...]
    groups: tuple[ClaimGroup, ...]
    scenes: tuple[SceneView, ...]
