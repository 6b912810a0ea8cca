"""A claim as the page shows it: its anchor, and its table's printed row where it has one."""

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from verify.scenes.results.claim import ClaimResult

if TYPE_CHECKING:
    from verify.pages.figures.captioned_plot import Plot

_PRINTED = "printed"  # how the printed row of a table claim's details begins


@dataclass(frozen=True)
class ClaimView:
    """A claim with its place on the page; `plot`: its table's picture, where it is a table."""

    result: ClaimResult
    anchor: str
    scene_anchor: str
    scene_title: str
    plot: "Plot | None" = None

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
