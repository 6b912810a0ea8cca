"""The tables of a paper's file beside its claims: figures, causes, and what is assumed.

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
disfavours = "the authors, whose …"          # whom the mistake puts in a worse light than the truth
origin = "One of the N entries is left at 0."  # how it may have come about, if `shown_by` shows it

An assumption is what the paper does not say and its readers have to choose:

[[assumption]]
says = "The cat stands at (q, p) = (1, 0)."
silence = "No place is printed."              # what the paper does, and does not, say of it
decides = [{ claim = "area", otherwise = "area-elsewhere" }]   # the same claim, otherwise assumed
settled_by = ["counted-from-1"]               # claims that show that nothing depends on it
"""

from collections.abc import Collection
from typing import Annotated, Literal

from pydantic import Field

from verify.errors import NOT_GIVEN, InputError
from verify.prose import Prose
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
    disfavours: ProseText = Prose("")
    """Whom the mistake puts in a worse light than the truth would, and by how much."""
    origin: ProseText = Prose("")
    """How the mistake may have come about."""

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


class Alternative(Frozen):
    """A claim under the assumption, and the claim that is the same otherwise."""

    claim: str
    """The id of the claim that assumes it."""
    otherwise: str
    """The id of the claim that assumes something else."""


class Assumption(WithProse):
    """A choice that the paper leaves open, with the verdicts that it decides."""

    says: ProseText
    """What is assumed, in a sentence."""
    silence: ProseText = Prose("")
    """What the paper says of it, and what it does not."""
    decides: Annotated[tuple[Alternative, ...], Field(max_length=100)] = ()
    """The verdicts that it may decide, each beside the one that stands otherwise."""
    settled_by: Annotated[tuple[str, ...], Field(max_length=100)] = ()
    """The ids of claims that show that no verdict depends on it."""

    def check(self, claims: Collection[str]) -> None:
        """Raise InputError if a claim is unknown, or if no claim is named."""
        pairs = [(alternative.claim, alternative.otherwise) for alternative in self.decides]
        if not pairs and not self.settled_by:
            raise InputError("decides", NOT_GIVEN, "or `settled_by` names the claims concerned")
        for name in (*(name for pair in pairs for name in pair), *self.settled_by):
            if name not in claims:
                key = "settled_by" if name in self.settled_by else "decides"
                raise InputError(key, name, "is no id of a claim of this file")
