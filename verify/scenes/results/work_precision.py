"""Results on error against run time, with exact decimal strings."""

from fractions import Fraction
from typing import Literal

from verify.scenes.frozen import Frozen, ProseText, Seconds, WithProse
from verify.scenes.results.bounded_value import Value
from verify.scenes.values import describe_rounding
from verify.structures import CanonicalForm, structure_in

LimitedBy = Literal["truncation", "rounding", "undecided", "tolerance", "failed"]


class WorkPoint(Frozen):
    """One run over [0, T]: of a scheme with `step_size`, or of a peer with `tolerance`.

    `error`: |z_N − z(N·h)|, Euclidean in (p, q), of the float64 state from the exact flow, where
    N is T/h, rounded down.
    `truncation`: the same of the scheme in exact arithmetic; `rounding`: how far the float64 state
    is from that. `energy`: |H(z_N) − H(z_0)|. `lam`: Λ in float64 by the closed form of ΔJ, exactly
    0 where that is proved; `lam_plain`: by the plain product of determinants, in the plane;
    `symplectic_defect`: max |W_N| in n degrees of freedom. `limited_by` is of
    `error`, `lambda_limited_by` of Λ, or of W; "tolerance" is a peer's, in which nothing tells
    truncation from rounding, "undecided" has its reason in `reason`. A failed run has no values;
    `failed_step` is the step at which it left its range. Seconds are those of the whole run, its
    compilation and the call itself apart; None if that takes longer than the run. `evaluations`:
    of the vector
    field in the whole run, where it is counted.
    """

    scheme: str
    step_size: str | None = None
    tolerance: str | None = None
    steps: int | None = None
    error: Value | None = None
    truncation: Value | None = None
    rounding: Value | None = None
    energy: Value | None = None
    lam: Value | None = None
    lam_plain: Value | None = None
    symplectic_defect: Value | None = None
    limited_by: LimitedBy
    lambda_limited_by: LimitedBy | None = None
    failed_step: int | None = None
    reason: str = ""
    seconds_min: Seconds | None = None
    seconds_median: Seconds | None = None
    evaluations: int | None = None

    @property
    def area_error(self) -> Value | None:
        """The defect of area, Λ; in n degrees of freedom that of the symplectic form, max |W_N|."""
        return self.symplectic_defect or self.lam


class SlopeResult(Frozen):
    """The order over the points limited by truncation; None if there are fewer than three."""

    value: str | None
    standard_error: str | None
    points: int
    reason: str


class CostResult(Frozen):
    """The operations of one step in the compiled loop, with each common subexpression once.

    `functions`: calls by name. `gradient`: evaluations of H_p and H_q, where the scheme consists of
    them (explicit Runge–Kutta, kicks and drifts); else None. `turn`: the operations of one
    iteration of Newton's method in addition, where equations are solved.
    """

    additions: int
    multiplications: int
    divisions: int
    functions: dict[str, int]
    gradient: dict[str, int] | None
    turn: "CostResult | None" = None

    @property
    def text(self) -> str:
        """The operations, such as "3 +, 2 ×, 1 sin", and those of an iteration of Newton's."""
        counts = {"+": self.additions, "×": self.multiplications, "÷": self.divisions}
        counts_text = ", ".join(
            f"{n} {operation}" for operation, n in (counts | self.functions).items() if n
        )
        return (
            counts_text
            if self.turn is None
            else f"{counts_text}, and a turn of Newton {self.turn.text}"
        )


class WorkLine(Frozen):
    """One scheme, or one peer, with its points in the order of falling step size or tolerance.

    In n degrees of freedom `area_preserving` says that the scheme is symplectic, S ≡ 0, and
    `lambda_slope` is of max |W_N|.
    """

    name: str
    peer: bool
    order: int | None
    area_preserving: bool
    error_slope: SlopeResult
    lambda_slope: SlopeResult
    cost: CostResult | None
    compile_seconds: Seconds
    points: tuple[WorkPoint, ...]


class SystemPoint(Frozen):
    """A number system at so many digits: how many of the end state it certifies, and how fast.

    `certified`: correct digits of the state, by a bound that is `error_kind`; None if the run
    gave none, and `reason` says why.
    """

    arithmetic: str
    digits: int
    certified: str | None
    error_kind: Literal["enclosed", "estimated"]
    error_method: str
    seconds_min: Seconds | None
    seconds_median: Seconds | None
    reason: str


class RatioResult(Frozen):
    """The ratio of the other's quantity to the one's at equal run time.

    `at` one run time, the middle one of those that both cover, and `least` … `most` over all of
    them. A ratio below 1 says that the other's is the smaller.
    """

    at: str
    least: str
    most: str


class ComparisonResult(WithProse):
    """Two schemes at equal run time `seconds`, over run times `first` … `last` that both cover.

    `error` and `area` are None if there is nothing to compare, and `sentence` says it all.
    """

    one: str
    other: str
    seconds: str | None
    first: str | None
    last: str | None
    error: RatioResult | None
    area: RatioResult | None
    sentence: ProseText


class WorkPrecisionResult(Frozen):
    """Error against run time over [0, `time`] from (q, p); see
    `verify.studies.work_precision.measurement`.

    `scale`: the size of the orbit, the greater |z| of its ends.
    `overhead`: seconds of an empty call, as it was subtracted. `rounding_share`: a rounding part
    that may be a greater share of an error limits it. `reference_bound`: of each coordinate.
    `machine`: the one that the run times are of. `left_out`: peers with the reason. `systems` are
    of one scheme at one step size.
    """

    hamiltonian: str
    parameters: dict[str, str]
    time: str
    t0: str = "0"
    q: str | tuple[str, ...]
    p: str | tuple[str, ...]
    repeats: int
    clock: str
    overhead: Seconds
    rounding_share: str
    scale: str
    reference: str
    reference_bound: str
    machine: str
    lines: tuple[WorkLine, ...]
    comparisons: tuple[ComparisonResult, ...]
    systems: tuple[SystemPoint, ...]
    systems_scheme: str
    systems_step_size: str
    left_out: tuple[tuple[str, str], ...]
    seconds: Seconds

    @property
    def structure(self) -> CanonicalForm:
        """The structure that the schemes are meant to preserve."""
        return structure_in(1 if isinstance(self.q, str) else len(self.q))

    @property
    def rounded_down(self) -> str:
        """A sentence on step sizes that do not divide T, whose error is that at t = N·h; or ""."""
        # Peers have tolerances in place of step sizes.
        points = (point for line in self.lines for point in line.points if point.step_size)
        steps = (Fraction(point.step_size or 1) for point in points)
        return describe_rounding(Fraction(self.time), steps)
