"""What was found: frozen results, exact decimal strings, the same after a JSON round trip."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, PlainSerializer

from verify.verdict import Verdict

_DECIMAL = r"^-?\d+(\.\d+)?(e[+-]\d+)?$"


Seconds = Annotated[float, PlainSerializer(repr, str, when_used="json")]


class Frozen(BaseModel):
    """A frozen model that refuses unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Value(Frozen):
    """A decimal whose printed digits are known, with the bound of its error."""

    value: Annotated[str, Field(pattern=_DECIMAL)]
    bound: Annotated[str, Field(pattern=_DECIMAL)]


class ProofResult(Frozen):
    """A `verify.proof.order.Proof`."""

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str
    verdict: Verdict
    reason: str
    order: int | None
    leading: str
    delta_j: str
    area_preserving: bool | None
    convergence_order: int | None
    witness: dict[str, str]
    enclosure: str
    p_next: str
    q_next: str
    jacobian: tuple[tuple[str, str], tuple[str, str]]
    seconds: Seconds


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
    observables that a proof gave and no run was needed for.
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


class CriterionResult(Frozen):
    """One of the paper's four criteria for one scheme in one scene."""

    number: int
    scheme: str
    verdict: Verdict
    evidence: str


class ClaimResult(Frozen):
    """One claim with its verdict; `evidence` is one line, `details` a table of texts."""

    id: str
    source: str
    statement: str
    scene: str
    verdict: Verdict
    evidence: str
    details: tuple[tuple[str, ...], ...] = ()


class SceneResult(Frozen):
    """Everything found for one scene; `time` is the length of its runs where it has a grid."""

    name: str
    title: str
    hamiltonian: str
    parameters: dict[str, str]
    source: str
    time: str | None
    proofs: tuple[ProofResult, ...]
    criteria: tuple[CriterionResult, ...]
    runs: tuple[RunResult, ...]
    series: tuple[RunResult, ...]


class Provenance(Frozen):
    """What made a report: the command, versions, machine, and time."""

    command: str
    versions: dict[str, str]
    machine: str
    seconds: Seconds
    kept: int  # results taken from an earlier, interrupted or finished, call
    computed: int


class Report(Frozen):
    """A whole report; its JSON is `results.json`."""

    title: str
    claims: tuple[ClaimResult, ...]
    scenes: tuple[SceneResult, ...]
    left_out: tuple[tuple[str, str], ...]
    provenance: Provenance
