"""The parts of Λ, or of W, by one way to evaluate it in float64, and their growth."""

from typing import ClassVar, Literal

from verify.scenes.frozen import Frozen, ProseText, WithProse
from verify.scenes.results.bounded_value import FormValue, Value
from verify.structures import AREA, SYMPLECTIC, CanonicalForm


class PartsOfRun(Frozen):
    """The parts of float64's value, which is the first field; `rounding`: the parts of rounding."""

    structure: ClassVar[CanonicalForm]
    rounding: ClassVar[tuple[str, ...]]

    @property
    def of_rounding(self) -> tuple[str, ...]:
        """The names of the parts of rounding, in the chain's order."""
        first, *others = self.rounding
        return first, *(["clock"] if hasattr(self, "clock") else []), *others

    def labels(self, mark: str) -> dict[str, str]:
        """Return the labels of the parts; those of rounding are their names after a `mark`."""
        working, *_ = type(self).model_fields
        wholes = {working: f"{self.structure.accumulated} in float64", "truncation": "truncation"}
        return wholes | {"total": "rounding"} | {n: mark + n for n in self.of_rounding}


class Parts(PartsOfRun):
    """truncation + input + trajectory + determinant + product = lambda_working (one equation of
    exact rationals, of which these are the known digits); total is the sum of the last four."""

    structure: ClassVar = AREA
    rounding: ClassVar = ("input", "trajectory", "determinant", "product")
    lambda_working: Value
    truncation: Value
    total: Value
    input: Value
    trajectory: Value
    determinant: Value
    product: Value


class PartsInTime(Parts):
    """The parts for an H that depends on time: the effect of float64's clock follows `input`."""

    clock: Value


class FormParts(PartsOfRun):
    """truncation + input + trajectory + derivatives + product = w_working, entry by entry (an
    equation of exact rationals, of which these are the known digits); total is the sum of the last
    four."""

    structure: ClassVar = SYMPLECTIC
    rounding: ClassVar = ("input", "trajectory", "derivatives", "product")
    w_working: FormValue
    truncation: FormValue
    total: FormValue
    input: FormValue
    trajectory: FormValue
    derivatives: FormValue
    product: FormValue


class FormPartsInTime(FormParts):
    """The parts for an H that depends on time: the effect of float64's clock follows `input`."""

    clock: FormValue


class PartsAt(Frozen):
    """The parts after `steps` steps, as decimals of a few digits, for a figure."""

    steps: int
    truncation: str
    total: str
    input: str
    trajectory: str
    determinant: str
    product: str


class PartsInTimeAt(PartsAt):
    """The parts after `steps` steps for an H that depends on time."""

    clock: str


class FormAt(Frozen):
    """‖M‖² of Frobenius and the greatest |entry| of w_working and of each part after `steps` steps.

    All numbers are decimals of a few digits.
    """

    steps: int
    norm_squared: str
    parts: dict[str, str]


# -- how they grow ---------------------------------------------------------------------------------


class GrowthResult(WithProse):
    """A `verify.studies.separation.growth_fits.Growth`."""

    exponent: str | None
    standard_error: str | None
    name: Literal["random walk", "drift", "undecided"]
    reason: ProseText
    first: int
    last: int
    points: int


class PowerLawResult(WithProse):
    """A `verify.studies.separation.growth_fits.PowerLaw`: measured, not proved."""

    exponent: str | None
    standard_error: str | None
    name: Literal["bounded", "N", "N²", "exponential", "undecided"]
    reason: ProseText


class TangentGrowth(WithProse):
    """The growth of the tangent map M, the product of float64's Jacobians, and its effect on W.

    `norm_squared`: ‖M_N‖² of Frobenius. `areas`: ‖∧²M_N‖, the root of the sum of the squares of all
    2 × 2 minors, the rate at which a 2-form grows; it is below ‖M_N‖². `finite_time_lyapunov`:
    ln(‖M_N‖/√(2n))/T per unit of time, with T in `time`. `motion`: the kind of growth of ‖M‖ in
    this run, and, where it is exponential, its `cause`: `at_half_step` is the exponent over the
    same time with half the step size (`verify.studies.separation.tangent`). `law`, `law_of_areas`:
    the laws of ‖M‖² and ‖∧²M‖ where the growth is not exponential. `per_area`: the greatest |entry|
    of the truncation of W_N, over ‖∧²M_N‖.
    """

    norm_squared: str
    areas: str
    time: str
    finite_time_lyapunov: str
    motion: Literal["exponential", "polynomial", "undecided"]
    cause: Literal["motion", "scheme", "undecided"] | None
    at_half_step: str | None
    law: PowerLawResult
    law_of_areas: PowerLawResult
    per_area: str
    meaning: ProseText


# -- all of it -------------------------------------------------------------------------------------


class EvaluationResult(Frozen):
    """Λ of a float64 run, split, by one way to evaluate it; `growth` is of total and each part.

    `largest`: the greatest |truncation| and |total| at the checkpoints of the run.
    """

    parts: PartsInTime | Parts
    largest: dict[str, str]
    growth: dict[str, GrowthResult]
    series: tuple[PartsInTimeAt | PartsAt, ...]
    error_kind: Literal["enclosed", "estimated"]


class FormEvaluation(Frozen):
    """W of a float64 run, split, by one way to evaluate it.

    `largest`: the greatest |entry| of truncation and of total at any checkpoint. `growth`: of the
    greatest |entry| of total and of each part, as for Λ. `law`: the measured growth with N of the
    greatest |entry| of w_working.
    """

    parts: FormPartsInTime | FormParts
    largest: dict[str, str]
    growth: dict[str, GrowthResult]
    law: PowerLawResult
    series: tuple[FormAt, ...]
    error_kind: Literal["enclosed", "estimated"]


AnyEvaluation = EvaluationResult | FormEvaluation
