"""A claim as the page shows it: its anchor, its group, and the printed row of its table."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.by_key import by_key
from verify.pages.sections.section import Counts
from verify.scenes.results.claim import ClaimResult, Standing
from verify.scenes.results.statement import Outcome, StatementResult
from verify.verdict import Verdict

_NUMBERED = re.compile(r"\d+(?:\.\d+)*(?=\D|$)")
_STANDINGS: dict[Standing, str] = {
    "fair": "",
    "strict": "taken strictly",
    "misprint": "to the letter, a misprint",
    "ours": "ours, not the paper’s",
}
_OUTCOMES = {
    Outcome.HOLDS: "holds as meant",
    Outcome.IN_SOME: "holds in some",
    Outcome.REFUTED: "refuted in each",
    Outcome.UNDECIDED: "undecided",
}
# The verdict whose colour a statement's outcome has.
COLOURS = {
    Outcome.HOLDS: Verdict.PROVED,
    Outcome.IN_SOME: Verdict.MEASURED,
    Outcome.REFUTED: Verdict.REFUTED,
    Outcome.UNDECIDED: Verdict.UNDECIDED,
}
# The printed row in the details of a table's claim begins with this word.
_PRINTED_ROW_START = "printed"


@dataclass(frozen=True)
class ClaimView:
    """A claim with its place on the page; `plot`: its table's picture, where it is a table.

    `statement`: the statement that it is a reading of, where statements are counted;
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
        """The statement's outcome, for the first of several readings; else ""."""
        if self.statement is None or self.is_later_reading or len(self.statement.readings) == 1:
            return ""
        return f"{len(self.statement.readings)} readings: {_OUTCOMES[self.statement.outcome]}"

    @property
    def tile_word(self) -> str:
        """The verdict, in small letters, of the tile on the first screen that counts the claim."""
        return (COLOURS[self.statement.outcome] if self.statement else self.result.verdict).lower()

    @property
    def standing(self) -> str:
        """The reading's departure from the printed text; "" for a fair reading."""
        return _STANDINGS[self.result.standing]

    @property
    def checkers(self) -> str:
        """The checkers of its proof, in a word each."""
        return ", ".join(dict.fromkeys(re.split("[:,]", by)[0] for by in self.result.checked_by))

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
            and details[1][0].startswith(_PRINTED_ROW_START)
            and all(head.startswith("h = ") for head in details[0][1:])
        )

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
    """The claims of one section of the paper; `title` is empty where no claim names a section."""

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
