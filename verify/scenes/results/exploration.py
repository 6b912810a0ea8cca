"""The results of an exploration, and its report."""

from verify.scenes.frozen import Frozen, Real
from verify.scenes.results.separation import SeparationResult


class Failure(Frozen):
    """The first scene, by its number, for which a property does not hold, with the message."""

    property: str
    example: int
    message: str


class ExploreResult(Frozen):
    """The counts of one stretch of scenes: those a property applies to, and those it fails for.

    `first`: the first failure of each property that failed.
    """

    looked_at: dict[str, int]
    failed: dict[str, int]
    first: tuple[Failure, ...]


class ShrunkResult(Failure):
    """The simplest scene, as TOML, for which the property was seen to fail, with the message."""

    scene: str


class PropertySummary(Frozen):
    """A property's counts: `looked_at`, the examples that it applies to, and its `failures`."""

    name: str
    sentence: str
    looked_at: int
    failures: int


class EarlierFailure(Frozen):
    """A failure of an earlier exploration, tried again; `message` is empty if it holds now."""

    file: str
    property: str
    message: str


class Worst(Frozen):
    """A scene, as TOML, and lg of its measure, which is the greater the worse it is."""

    value: Real
    scene: str


class HuntResult(Frozen):
    """The worst scenes of a hunt, or of one of its islands, in order, one for each shape of H.

    `examples`: the number of scenes that were measured.
    """

    worst: tuple[Worst, ...]
    examples: int


class GalleryScene(Worst):
    """One of the worst scenes, as TOML, with lg of its measure.

    `orbit`: points (q, p) of the hunt's run, with 40 digits. `separation`: its Λ over a longer run;
    where that did not finish it is `longer`, and `separation` that of the hunt's run.
    `meaningless_after`: the first checkpoint, in steps, at which the greatest |rounding| so far is
    as large as the greatest |truncation| so far in the plain way; `meaningful_from`: that from
    which on it never is again.
    """

    orbit: tuple[tuple[str, str], ...]
    separation: SeparationResult
    longer: SeparationResult | None = None
    meaningless_after: int | None
    meaningful_from: int | None = None


class Gallery(Frozen):
    """The worst scenes of a hunt, the worst first; `examples` were measured.

    Initial values are in `reach` of 0 in p and q, step sizes between the two of `step_sizes`, and
    the search moves |coefficients| of H between the two of `coefficients`.
    """

    measure: str
    sentence: str
    seed: int
    examples: int
    steps: int
    reach: str
    step_sizes: tuple[str, str]
    coefficients: tuple[str, str]
    scenes: tuple[GalleryScene, ...]


class ExploreReport(Frozen):
    """The report; `failures`: shrunk, one for each property; `again`: earlier failures, retried."""

    seed: int
    examples: int
    properties: tuple[PropertySummary, ...]
    failures: tuple[ShrunkResult, ...]
    again: tuple[EarlierFailure, ...] = ()
