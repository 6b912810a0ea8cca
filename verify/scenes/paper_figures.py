"""A paper's figures, to be made again from our own runs, with the claims drawn from them.

[[figure]]
label = "Figure 6"
caption = "Comparison of flow …"   # the paper's own
scene = "duffing"
shows = "flow"                     # the scene's [[flow]] of that source; or "series", its
                                   # [[series]] of that source, or "runs", its [grid]
assumed = "Where the cat stands."  # what the paper leaves open; may be left out
claims = ["duffing-flow-area"]     # what the paper draws from it: ids of claims of the file
"""

from collections.abc import Collection
from typing import Annotated, Literal

from pydantic import Field

from verify.errors import InputError
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene


class PaperFigure(Frozen):
    """See the module's text for the keys."""

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
        """Raise InputError where the scene lacks the section to show, or a claim is unknown."""
        for claim in self.claims:
            if claim not in claims:
                raise InputError("claims", claim, "is no id of a claim of this file")
        sources = {
            "runs": {self.label} if scene.grid else set(),
            "series": {series.source for series in scene.series},
            "flow": {flow.source for flow in scene.flow},
        }[self.shows]
        if self.label not in sources:
            where = "has no [grid]" if self.shows == "runs" else f"has no [[{self.shows}]] of it"
            raise InputError("label", self.label, f"the scene {self.scene} {where}")
