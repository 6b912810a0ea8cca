"""What an exploration found, and its report."""

from verify.results import Frozen


class Failure(Frozen):
    """The first scene, by its number, for which a property does not hold, and what was found."""

    property: str
    example: int
    message: str


class ExploreResult(Frozen):
    """Of one stretch of drawn scenes: how many each property spoke of, and for how many not held.

    `first`: one a property that failed.
    """

    looked_at: dict[str, int]
    failed: dict[str, int]
    first: tuple[Failure, ...]


class ShrunkResult(Frozen):
    """The simplest scene found for which the property fails, as TOML, and what is found there."""

    property: str
    example: int
    message: str
    scene: str


class PropertySummary(Frozen):
    """`looked_at`: examples that the property speaks of; `failures`: for how many it fails."""

    name: str
    sentence: str
    looked_at: int
    failures: int


class FoundAgain(Frozen):
    """A scene that an earlier exploration found, looked at again; `message` is empty if it holds
    now."""

    file: str
    property: str
    message: str


class ExploreReport(Frozen):
    """`failures`: one a property that fails, shrunk; `again`: scenes found earlier."""

    seed: int
    examples: int
    properties: tuple[PropertySummary, ...]
    failures: tuple[ShrunkResult, ...]
    again: tuple[FoundAgain, ...] = ()
