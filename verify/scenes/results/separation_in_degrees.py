"""Truncation and rounding in W, the symplectic defect of a run in n degrees of freedom."""

from fractions import Fraction
from itertools import combinations
from math import isqrt
from typing import ClassVar, Literal

from verify.scenes.frozen import Frozen, OfScheme, Said, Seconds, WithProse
from verify.scenes.results.bounded_value import Value
from verify.scenes.results.separation import (
    Chain,
    EvaluationResult,
    GridOf,
    GrowthResult,
    SeparationGrid,
    SeparationResult,
    parts_table,
)

FORM_ROUNDING = ("input", "trajectory", "derivatives", "product")
FORM_SHOWN = {"w_working": "W in float64", "truncation": "truncation", "total": "rounding"}
Rows = tuple[tuple[str, ...], ...]


class FormValue(Frozen):
    """An antisymmetric 2n × 2n matrix of decimal strings, rows and columns p1 … pn, q1 … qn, with
    the bound of each entry's error."""

    value: Rows
    bound: Rows

    @classmethod
    def of(cls, entries: tuple[Value, ...]) -> "FormValue":
        """That of the entries above the diagonal, row by row."""
        size = (1 + isqrt(1 + 8 * len(entries))) // 2  # of rows: size (size − 1)/2 entries
        zero = Value(value="0", bound="0")
        full = [[zero] * size for _ in range(size)]
        for (a, b), entry in zip(combinations(range(size), 2), entries, strict=True):
            full[a][b], full[b][a] = entry, -entry
        return cls(
            value=tuple(tuple(x.value for x in row) for row in full),
            bound=tuple(tuple(x.bound for x in row) for row in full),
        )

    @property
    def exact(self) -> tuple[tuple[Fraction, ...], ...]:
        """The matrix that `value` is, as rationals."""
        return tuple(tuple(map(Fraction, row)) for row in self.value)

    def entry(self, a: int, b: int) -> Value:
        """One entry, row and column from 0."""
        return Value(value=self.value[a][b], bound=self.bound[a][b])

    @property
    def place(self) -> tuple[int, int]:
        """Row and column of the greatest |entry|, above the diagonal."""
        places = combinations(range(len(self.value)), 2)
        return max(places, key=lambda at: abs(Fraction(self.value[at[0]][at[1]])))

    @property
    def largest(self) -> Value:
        """The entry of the greatest size, with its sign."""
        return self.entry(*self.place)

    def __str__(self) -> str:
        return f"{self.largest} at the greatest entry"


class FormParts(Chain):
    """truncation + input + trajectory + derivatives + product = w_working, entry by entry (an
    equation of exact rationals, of which these are the known digits); total is the sum of the last
    four."""

    rounding: ClassVar = FORM_ROUNDING
    w_working: FormValue
    truncation: FormValue
    total: FormValue
    input: FormValue
    trajectory: FormValue
    derivatives: FormValue
    product: FormValue


class FormPartsInTime(FormParts):
    """Of an H that depends on time: what float64's clock does stands between input and
    trajectory."""

    clock: FormValue


class FormAt(Frozen):
    """After `steps` steps: ‖M‖² of Frobenius, and the greatest |entry| of w_working and of each
    part, as decimals of a few digits."""

    steps: int
    norm_squared: str
    parts: dict[str, str]


class PowerLawResult(WithProse):
    """A `verify.studies.separation.growth.PowerLaw`: measured, not proved."""

    exponent: str | None
    standard_error: str | None
    name: Literal["bounded", "N", "N²", "exponential", "undecided"]
    reason: Said


class FormEvaluation(Frozen):
    """W of a float64 run, split, for one way to evaluate it.

    `largest`: the greatest |entry| of truncation and of total at any checkpoint. `growth`: of the
    greatest |entry| of total and of each part, as of Λ. `law`: how that of w_working grows with N,
    measured.
    """

    parts: FormPartsInTime | FormParts
    largest: dict[str, str]
    growth: dict[str, GrowthResult]
    law: PowerLawResult
    series: tuple[FormAt, ...]
    error_kind: Literal["enclosed", "estimated"]


class TangentGrowth(WithProse):
    """How M, the product of the Jacobians that float64 computed, grew, and what follows for W.

    `norm_squared`: ‖M_N‖² of Frobenius. `areas`: ‖∧²M_N‖, the root of the sum of all squares of its
    2 × 2 minors, as which a 2-form grows, and which is below ‖M_N‖². `finite_time_lyapunov`:
    ln(‖M_N‖/√(2n))/T per unit of time, `time` T. `motion`: whether ‖M‖ grew exponentially in this
    run, and then `cause`, whose that growth is: `at_half_step` is the exponent over the same time
    with half the step size (`verify.studies.separation.tangent`). `law`, `law_of_areas`: those
    of ‖M‖² and ‖∧²M‖ where it did not. `per_area`: the greatest |entry| of the truncation of W_N,
    over ‖∧²M_N‖.
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
    meaning: Said


class SeparationInDegrees(OfScheme):
    """Truncation and rounding in W of one run in float64, in n degrees of freedom; see
    `verify.studies.separation.ways.matrices`.

    `coordinates` name the rows and columns of all matrices. `plain` takes W = MᵀΩM − Ω of float64's
    M, `closed_form` sums MᵀSM. All are None where `status` is not "finished"; `reason` says why.
    """

    arithmetic: str
    digits: int
    step_size: str
    steps: int
    coordinates: tuple[str, ...]
    q: tuple[str, ...]
    p: tuple[str, ...]
    t0: str = "0"
    status: Literal["finished", "left range", "unresolved"]
    failed_step: int | None
    reason: str
    plain: FormEvaluation | None
    closed_form: FormEvaluation | None
    tangent: TangentGrowth | None
    error_method: str
    seconds: Seconds

    def __repr__(self) -> str:
        what = f"{self.scheme}, {self.steps} steps of h = {self.step_size}"
        if self.plain is None:
            return f"SeparationInDegrees({what}: {self.status})"
        parts = self.plain.parts
        sizes = f"truncation {parts.truncation.largest}, rounding {parts.total.largest}"
        return f"SeparationInDegrees({what}: greatest entries: {sizes})"

    def name_of(self, place: tuple[int, int]) -> str:
        """An entry as a 2-form: dp1∧dq1."""
        return "∧".join(f"d{self.coordinates[k]}" for k in place)

    def _repr_html_(self) -> str:
        """The greatest entry of each part for each way to evaluate W, with its bound."""
        meaning = f"the greatest entry of each; {self.tangent.meaning} " if self.tangent else ""
        return parts_table(self, "W", FORM_SHOWN, lambda matrix: str(matrix.largest), meaning)


class SeparationGridInDegrees(GridOf[SeparationInDegrees]):
    """The separation of W for several step sizes, in the order given, and the crossover of the
    greatest entries, each way."""

    def _repr_html_(self) -> str:
        """Each step size in full, one below the other."""
        return "".join(point._repr_html_() for point in self.points)


AnyEvaluation = EvaluationResult | FormEvaluation
AnySeparation = SeparationResult | SeparationInDegrees
AnyGrid = SeparationGrid | SeparationGridInDegrees
