"""A claim as the page shows it: its anchor, its table's printed row where it has one, its group."""

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
_PRINTED = "printed"  # how the printed row of a table claim's details begins


@dataclass(frozen=True)
class ClaimView:
    """A claim with its place on the page; `plot`: its table's picture, where it is a table.

    `of`: the statement that it is a reading of, where statements are counted; `again`: whether
    another reading of it stands before this one.
    """

    result: ClaimResult
    anchor: str
    scene_anchor: str
    scene_title: str
    plot: Plot | None = None
    of: StatementResult | None = None
    again: bool = False

    @property
    def outcome(self) -> str:
        """What holds of the statement, with the first of its several readings."""
        if self.of is None or self.again or len(self.of.readings) == 1:
            return ""
        return f"{len(self.of.readings)} readings: {_OUTCOMES[self.of.outcome]}"

    @property
    def told(self) -> str:
        """By which tile of the first screen it is counted: a verdict in small letters."""
        return (COLOURS[self.of.outcome] if self.of else self.result.verdict).lower()

    @property
    def standing(self) -> str:
        """How it stands to what is printed, where it is no fair reading."""
        return _STANDINGS[self.result.standing]

    @property
    def who(self) -> str:
        """Who checked its proof, in a word each."""
        return ", ".join(dict.fromkeys(re.split("[:,]", by)[0] for by in self.result.checked_by))

    @property
    def name(self) -> str:
        """What the page calls it."""
        return self.result.source or self.result.id

    @property
    def is_table(self) -> bool:
        details = self.result.details
        return (
            len(details) > 2
            and len(details[0]) > 1
            and all(len(row) == len(details[0]) for row in details)
            and details[1][0].startswith(_PRINTED)
            and all(head.startswith("h = ") for head in details[0][1:])
        )

    @property
    def step_sizes(self) -> list[str]:
        return [head.removeprefix("h = ") for head in self.result.details[0][1:]]

    @property
    def printed(self) -> tuple[str, ...]:
        return self.result.details[1][1:]

    @property
    def computed(self) -> tuple[tuple[str, ...], ...]:
        return self.result.details[2:]

    @property
    def by_step_size(self) -> list[tuple[str, tuple[str, ...]]]:
        """Each step size with what is printed for it and, in the order of `computed`, computed."""
        columns = zip(self.printed, *(row[1:] for row in self.computed), strict=True)
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
        while anchor in self._taken:
            count += 1
            anchor = f"{kind}-{slug}-{count}"
        self._taken.add(anchor)
        return anchor


# -- the sections of the paper --------------------------------------------------------------------


def groups(claims: Sequence[ClaimView], anchors: Anchors) -> list[ClaimGroup]:
    """The claims by section, sections in the order of their numbers, those without one last."""
    by_section = by_key(claims, lambda claim: claim.result.section)
    found = []
    for section in sorted(by_section, key=_place):
        own = by_section[section]
        title = section or ("Other claims" if len(by_section) > 1 else "")
        counted = Counter(c.result.verdict for c in own)
        counts = tuple((v, counted[v]) for v in Verdict if counted[v])
        found.append(ClaimGroup(title, anchors.take("section", title or "all"), tuple(own), counts))
    return found


def _place(section: str) -> tuple[int, list[int]]:
    """Sorts 4.2 before 4.10, then sections without a number, then what names none."""
    if match := _NUMBERED.match(section):
        return 0, [int(n) for n in match[0].split(".")]
    return (1 if section else 2), []
