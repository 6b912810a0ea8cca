"""The growth law of Λ on one orbit, and its predictions of Λ for runs."""

from typing import Literal

from verify.scenes.frozen import Frozen, OfScheme, ProseText, Seconds, WithProse
from verify.scenes.results.bounded_value import Value


class AverageResult(OfScheme, WithProse):
    """The growth law of Λ on one orbit: see `verify.proof.plane.growth_law`.

    `power`: ⟨g⟩ stands with h^power T (0: there is no law). `g` and `potential` are formulas.
    `telescopes`: whether the leading coefficient of ΔJ is X·`potential`, None if that is not
    decided; `by_potential`: the law is written with it, and g is the next coefficient. Else g is
    the leading one. `average` (⟨g⟩) and
    `period` are along the exact orbit through (q, p); `average` is None if the orbit is not
    known to be closed, and `reason` says why; `period` is None at an equilibrium too.
    """

    digits: int
    q: str
    p: str
    power: int
    g: str
    potential: str
    telescopes: bool | None
    by_potential: bool
    orbit: Literal["libration", "rotation", "equilibrium", "undecided"]
    reason: ProseText
    average: Value | None
    period: Value | None
    error_kind: Literal["enclosed", "estimated"]
    error_method: str
    seconds: Seconds


class PredictionResult(Frozen):
    """Λ of one run as the growth law predicts it, and as it was measured.

    `boundary` + `secular` = log(1 + Λ), of which `predicted` is the Λ; `difference` is
    (predicted − measured) / |measured|, None if no digit of the measured Λ is known.
    """

    step_size: str
    steps: int
    boundary: Value
    secular: Value
    predicted: Value
    measured: Value
    difference: Value | None


class GrowthLawResult(Frozen):
    """The law on one orbit, with the runs of the grid that start there, by step size."""

    law: AverageResult
    predictions: tuple[PredictionResult, ...]
