"""What was found: frozen results, exact decimal strings, the same after a JSON round trip."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, PlainSerializer

from verify.algebra.conditions import Condition
from verify.verdict import Verdict

_DECIMAL = r"^-?\d+(\.\d+)?(e[+-]\d+)?$"


Real = Annotated[float, PlainSerializer(repr, str, when_used="json")]  # of no exact value
Seconds = Real


class Frozen(BaseModel):
    """A frozen model that refuses unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Value(Frozen):
    """A decimal whose printed digits are known, with the bound of its error."""

    value: Annotated[str, Field(pattern=_DECIMAL)]
    bound: Annotated[str, Field(pattern=_DECIMAL)]


class ProofResult(Frozen):
    """A `verify.proof.order.Proof`; closed forms are None where too large, or not asked for."""

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str
    verdict: Verdict
    reason: str
    order: int | None
    leading: str
    delta_j: str | None
    area_preserving: bool | None
    convergence_order: int | None
    witness: dict[str, str]
    enclosure: str
    p_next: str | None
    q_next: str | None
    jacobian: tuple[tuple[str, str], tuple[str, str]] | None
    seconds: Seconds


class EveryResult(Frozen):
    """A `verify.proof.every.EveryProof`; `argument`: what is proved on paper beside it."""

    scheme: str
    quantifier: str
    verdict: Verdict
    reason: str
    order: int | None
    area_preserving: bool | None
    convergence_order: int | None
    formula: str
    leading: str
    telescopes: bool | None
    potential: str | None
    why: str
    checked: tuple[str, ...]
    conditions: tuple[Condition, ...] = ()
    argument: str


class SeriesPoint(Frozen):
    """The least and greatest ΔJ and Λ over the steps first … last."""

    first: int
    last: int
    delta_j: tuple[str, str]
    lam: tuple[str, str]


class RunResult(Frozen):
    """One run of N steps of a scheme in one arithmetic.

    `values` holds p, q and the observables asked for. It is empty where the orbit left the
    arithmetic's range (`status` "left range"; `failed_step` is the first step that was out of it),
    and where no digit could be confirmed ("unresolved"). `error_kind`
    is "enclosed" where every bound is rigorous, else "estimated", by `error_method`. `fallback`
    says why another arithmetic was taken than the one that was asked for. `exact` names the
    observables that a proof gave and no run was needed for. `source` is what of a paper the scene
    says that the run repeats.
    """

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str
    arithmetic: str
    fallback: str = ""
    digits: int
    step_size: str
    steps: int
    q: str
    p: str
    status: Literal["finished", "left range", "unresolved"]
    failed_step: int | None
    values: dict[str, Value]
    error_kind: Literal["enclosed", "estimated"]
    error_method: str
    exact: tuple[str, ...]
    series: tuple[SeriesPoint, ...]
    seconds: Seconds
    source: str = ""

    def _repr_html_(self) -> str:
        from verify.notebook import run_html

        return run_html(self)

    def _repr_latex_(self) -> str:
        from verify.notebook import run_latex

        return run_latex(self)


class Parts(Frozen):
    """truncation + input + trajectory + determinant + product = lambda_working (one equation of
    exact rationals, of which these are the known digits); total is the sum of the last four."""

    lambda_working: Value
    truncation: Value
    total: Value
    input: Value
    trajectory: Value
    determinant: Value
    product: Value


class PartsAt(Frozen):
    """The parts after `steps` steps, as decimals of a few digits, for a figure."""

    steps: int
    truncation: str
    total: str
    input: str
    trajectory: str
    determinant: str
    product: str


class GrowthResult(Frozen):
    """A `verify.studies.separation.growth.Growth`."""

    exponent: str | None
    standard_error: str | None
    name: Literal["random walk", "drift", "undecided"]
    reason: str
    first: int
    last: int
    points: int


class EvaluationResult(Frozen):
    """Λ of a float64 run, split, for one way to evaluate it; `growth`: of total and of each part.

    `largest`: the greatest |truncation| and |total| at the checkpoints of the run.
    """

    parts: Parts
    largest: dict[str, str]
    growth: dict[str, GrowthResult]
    series: tuple[PartsAt, ...]
    error_kind: Literal["enclosed", "estimated"]


class SeparationResult(Frozen):
    """Truncation and rounding in Λ of one run in float64; see `verify.studies.separation.separate`.

    `plain` and `closed_form` are None where `status` is not "finished" (`reason` says why), and
    `closed_form` also where some det J ≤ 0, whose logarithm it would take. `arithmetic` is what
    stood for exact arithmetic; `seconds` is the stepping of all runs.
    """

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str
    arithmetic: str
    digits: int
    step_size: str
    steps: int
    q: str
    p: str
    status: Literal["finished", "left range", "unresolved"]
    failed_step: int | None
    reason: str
    plain: EvaluationResult | None
    closed_form: EvaluationResult | None
    error_method: str
    seconds: Seconds

    def _repr_html_(self) -> str:
        from verify.notebook import separation_html

        return separation_html(self)


class CrossoverResult(Frozen):
    """A `verify.studies.separation.growth.Crossover`."""

    step_size: str | None
    bracket: tuple[str, str] | None
    reason: str


class SeparationGrid(Frozen):
    """The separation for several step sizes, in the order given, and the crossover of each way."""

    points: tuple[SeparationResult, ...]
    plain: CrossoverResult
    closed_form: CrossoverResult

    def _repr_html_(self) -> str:
        from verify.notebook import grid_html

        return grid_html(self)


class AverageResult(Frozen):
    """The growth law of Λ on one orbit: see `verify.proof.growth_law`.

    `power`: ⟨g⟩ stands with h^power T (0: there is no law). `g` and `potential` are formulas;
    `potential` is empty where the leading coefficient of ΔJ does not telescope. `average` (⟨g⟩) and
    `period` are along the exact orbit through (q, p); `average` is None where the orbit is not
    known to be closed, and `reason` says why; `period` is None at an equilibrium too.
    """

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str
    digits: int
    q: str
    p: str
    power: int
    g: str
    potential: str
    orbit: Literal["libration", "rotation", "equilibrium", "undecided"]
    reason: str
    average: Value | None
    period: Value | None
    error_kind: Literal["enclosed", "estimated"]
    error_method: str
    seconds: Seconds


class PredictionResult(Frozen):
    """Λ of one run as the growth law predicts it, and as it was measured.

    `boundary` + `secular` = log(1 + Λ), of which `predicted` is the Λ; `difference` is
    (predicted − measured) / |measured|, None where no digit of the measured Λ is known.
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


class CriterionResult(Frozen):
    """One of the paper's four criteria for one scheme in one scene."""

    number: int
    scheme: str
    verdict: Verdict
    evidence: str


class ClaimResult(Frozen):
    """One claim with its verdict; `evidence` is one line, `details` a table of texts.

    `scene` is empty where the claim speaks of every H. `section` is where it stands in its paper,
    such as "4.1 The Duffing system"; a report groups its claims by it.
    `proof`: the argument on paper that stands beside what the machine checked, where there is one.
    `reproduction`: a few lines of code that show what is said of someone else's code.
    """

    id: str
    kind: str = ""
    source: str
    section: str = ""
    statement: str
    scene: str
    verdict: Verdict
    evidence: str
    details: tuple[tuple[str, ...], ...] = ()
    proof: str = ""
    reproduction: str = ""
