"""What an exploration found, and its report."""

from verify.results import Frozen, Real, SeparationResult


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


class Worst(Frozen):
    """A scene, as TOML, and lg of how bad it is."""

    value: Real
    scene: str


class HuntResult(Frozen):
    """The worst scenes of one island of a hunt, the worst first; so many were looked at."""

    worst: tuple[Worst, ...]
    examples: int


class GalleryScene(Frozen):
    """One of the worst scenes, as TOML, with lg of its measure.

    `orbit`: points (q, p) of the hunt's run, with 40 digits. `separation`: its Λ over a longer run;
    `meaningless_after`: the first checkpoint, in steps, at which rounding is as large as truncation
    in the plain way.
    """

    value: Real
    scene: str
    orbit: tuple[tuple[str, str], ...]
    separation: SeparationResult
    meaningless_after: int | None


class Gallery(Frozen):
    """The worst scenes of a hunt, the worst first.

    Initial values are in `reach` of 0 in p and q, and step sizes between the two of `step_sizes`.
    """

    measure: str
    sentence: str
    seed: int
    examples: int
    steps: int
    reach: str
    step_sizes: tuple[str, str]
    scenes: tuple[GalleryScene, ...]


class ExploreReport(Frozen):
    """`failures`: one a property that fails, shrunk; `again`: scenes found earlier."""

    seed: int
    examples: int
    properties: tuple[PropertySummary, ...]
    failures: tuple[ShrunkResult, ...]
    again: tuple[FoundAgain, ...] = ()
