"""The tables of a paper's file beside its claims: figures to be made again, and causes.

A figure is made again from our own runs, with the claims drawn from it:

[[figure]]
label = "Figure 6"
caption = "Comparison of flow …"   # the paper's own
scene = "duffing"
shows = "flow"                     # the scene's [[flow]] of that source; or "series", its
                                   # [[series]] of that source, or "runs", its [grid]
assumed = "Where the cat stands."  # what the paper leaves open; may be left out
claims = ["duffing-flow-area"]     # what the paper draws from it: ids of claims of the file

A cause is one mistake, or one fact, that explains why several statements do not hold:

[[cause]]
says = "Both tables print `1/N` for MSE."   # in a sentence; a formula stands between backticks
explains = ["table-1", "table-2"]            # statements that do not hold because of it
shown_by = ["mse-is-1-over-n"]               # claims, ours, that show it; may be left out
"""

from collections.abc import Collection
from typing import Annotated, Literal

from pydantic import Field

from verify.errors import InputError
from verify.scenes.frozen import Frozen, ProseText, WithProse
from verify.scenes.scene import Scene


class PaperFigure(Frozen):
    """A figure of the paper that is made again from our runs; see the module's text."""

    label: Annotated[str, Field(min_length=1, max_length=80)]
    """What the paper calls it."""
    caption: Annotated[str, Field(max_length=1000)] = ""
    """The paper's own caption."""
    scene: str
    """The scene whose runs it is made from."""
    shows: Literal["runs", "series", "flow"]
    """What of the scene it shows: the section whose `source` is the label, or its `[grid]`."""
    assumed: Annotated[str, Field(max_length=2000)] = ""
    """What the paper leaves open, and is assumed here."""
    claims: Annotated[tuple[str, ...], Field(max_length=100)] = ()
    """The ids of the claims that the paper draws from it."""

    def check(self, scene: Scene, claims: Collection[str]) -> None:
        """Raise InputError if the scene lacks the section to show, or a claim is unknown."""
        for claim in self.claims:
            if claim not in claims:
                raise InputError("claims", claim, "is no id of a claim of this file")
        sources = {
            "runs": {self.label} if scene.grid else set(),
            "series": {series.source for series in scene.series},
            "flow": {flow.source for flow in scene.flow},
        }[self.shows]
        if self.label not in sources:
            lack = "has no [grid]" if self.shows == "runs" else f"has no [[{self.shows}]] of it"
            raise InputError("label", self.label, f"the scene {self.scene} {lack}")


class Cause(WithProse):
    """A mistake or a fact that explains why several statements do not hold."""

    says: ProseText
    """The cause in a sentence."""
    explains: Annotated[tuple[str, ...], Field(min_length=1, max_length=100)]
    """The ids of the statements that it explains."""
    shown_by: Annotated[tuple[str, ...], Field(max_length=100)] = ()
    """The ids of the claims that show it."""

    def check(self, statements: Collection[str], claims: Collection[str]) -> None:
        """Raise InputError if a statement or a claim is unknown."""
        # Unknown ids are refused here, since a page would silently show no link for them.
        for key, names, allowed in (
            ("explains", self.explains, statements), ("shown_by", self.shown_by, claims),
        ):  # fmt: skip
            for name in names:
                if name not in allowed:
                    kind = "statement" if key == "explains" else "claim"
                    raise InputError(key, name, f"is no id of a {kind} of this file")
