"""Claims of a paper: what each kind states, and the file that holds them.

A claims file is TOML: `[[claim]]` tables with `id`, `source`, `statement`, `scene` (the name of the
scene it speaks of), `kind`, and what the kind asks for. See `exact_claims` and `measured_claims`
for the checks; a claim's verdict always comes with evidence.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, TypeAdapter, ValidationError, model_validator

from verify.criteria import judge
from verify.errors import InputError
from verify.execute import Result
from verify.plan import grid_task, growth_task, key, proof_task, separation_task
from verify.results import (
    AverageResult,
    ClaimResult,
    CriterionResult,
    Frozen,
    ProofResult,
    RunResult,
    SeparationResult,
)
from verify.scene import Grid, Number, Scene, StepSize, one_line, read_toml
from verify.verdict import Verdict


class _Claim(Frozen):
    id: str
    source: str
    statement: str
    scene: str
    scheme: str


class StepMapClaim(_Claim):
    """The scheme's step map is this one; `q_next` may use p_next."""

    kind: Literal["step_map"]
    p_next: str
    q_next: str


class JacobianClaim(_Claim):
    """The Jacobian's entries (Eq. 12), by rows."""

    kind: Literal["jacobian"]
    entries: tuple[tuple[str, str], tuple[str, str]]


class DeltaJClaim(_Claim):
    """ΔJ is `formula`: exactly, or up to O(h^up_to).

    `delta_j`: printed as ΔJ itself. `mse_summand`: printed inside the square of Eq. 15.
    `lambda_factor`: printed as the factor det J of Eq. 16.
    """

    kind: Literal["delta_j", "mse_summand", "lambda_factor"]
    formula: str
    up_to: Annotated[int, Field(ge=1, le=64)] | None = None


class TableClaim(_Claim):
    """lg MSE as printed, for each step size; every initial value of the grid has this row."""

    kind: Literal["table"]
    step_sizes: Annotated[tuple[StepSize, ...], Field(min_length=1)]
    printed: tuple[Annotated[str, Field(pattern=r"^-?\d{1,20}(\.\d{1,40})?$")], ...]

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.printed) != len(self.step_sizes):
            raise InputError("printed", len(self.printed), f"give {len(self.step_sizes)} values")
        return self


Quantity = Literal["mse", "abs_lambda", "mse_over_lambda", "delta_j_max"]


class SpreadClaim(_Claim):
    """At each step size the quantity varies over the initial values by this factor at most."""

    kind: Literal["spread"]
    quantity: Quantity
    factor: Annotated[Number, Field(ge=1)]


class MonotoneClaim(_Claim):
    """For each initial value the quantity does this as the step size increases."""

    kind: Literal["monotone"]
    quantity: Quantity
    direction: Literal["increases", "decreases"]


class LessClaim(_Claim):
    """The one quantity is smaller than the other at each step size and initial value."""

    kind: Literal["less"]
    quantity: Quantity
    than: Quantity


class MagnitudeClaim(_Claim):
    """At `step_size` each quantity is about 10^its exponent: its lg within ½ of it.

    For some initial value of the grid, or for every one.
    """

    kind: Literal["magnitude"]
    step_size: StepSize
    exponents: Annotated[dict[Quantity, int], Field(min_length=1)]
    quantifier: Literal["some", "every"]


class CriteriaClaim(_Claim):
    """The scheme satisfies these criteria."""

    kind: Literal["criteria"]
    numbers: Annotated[
        tuple[Annotated[int, Field(ge=1, le=4, strict=True)], ...], Field(min_length=1)
    ]


Claim = Annotated[
    StepMapClaim
    | JacobianClaim
    | DeltaJClaim
    | TableClaim
    | SpreadClaim
    | MonotoneClaim
    | LessClaim
    | MagnitudeClaim
    | CriteriaClaim,
    Field(discriminator="kind"),
]
_CLAIMS: TypeAdapter[Any] = TypeAdapter(Claim)


@dataclass(frozen=True)
class Findings:
    """The scenes with all results that were computed for them."""

    scenes: Mapping[str, Scene]
    results: Mapping[str, Result] = field(default_factory=dict)

    def scene(self, name: str) -> Scene:
        if name not in self.scenes:
            raise InputError("claim.scene", name, f"unknown; allowed: {', '.join(self.scenes)}")
        return self.scenes[name]

    def proof(self, scene: Scene, scheme: str) -> ProofResult:
        if scheme not in scene.schemes:
            known = ", ".join(scene.schemes)
            raise InputError("claim.scheme", scheme, f"is not in scene {scene.name}: {known}")
        result = self.results[key(proof_task(scene, scheme))]
        assert isinstance(result, ProofResult)  # noqa: S101 - the key is a proof's
        return result

    def runs(self, scene: Scene, scheme: str) -> list[RunResult]:
        """The grid's runs by initial value, then step size; empty where none were needed."""
        if scene.grid is None:
            return []
        names = [
            key(grid_task(scene, scheme, h, start))
            for start in range(len(scene.grid.initial_values))
            for h in scene.grid.step_sizes
        ]
        found = [self.results.get(name) for name in names]
        return [r for r in found if isinstance(r, RunResult)]

    def separations(self, scene: Scene, scheme: str, grid: Grid) -> list[SeparationResult]:
        """The separations over a grid by initial value, then step size."""
        names = [
            key(separation_task(scene, scheme, grid, h, start))
            for start in range(len(grid.initial_values))
            for h in grid.step_sizes
        ]
        found = [self.results.get(name) for name in names]
        return [r for r in found if isinstance(r, SeparationResult)]

    def growth_laws(self, scene: Scene, scheme: str) -> list[AverageResult]:
        """The growth laws of the grid's orbits, by initial value; empty where none were asked."""
        if scene.grid is None:
            return []
        starts = range(len(scene.grid.initial_values))
        found = [self.results.get(key(growth_task(scene, scheme, start))) for start in starts]
        return [r for r in found if isinstance(r, AverageResult)]

    def criterion(self, scene: Scene, scheme: str, number: int) -> CriterionResult:
        return judge(number, self.proof(scene, scheme), self.runs(scene, scheme))


def load_claims(path: Path) -> list[Claim]:
    """The claims in a TOML file; InputError names the file, the claim and the problem."""
    data = read_toml(path)
    if set(data) != {"claim"} or not isinstance(data["claim"], list):
        raise InputError("file", path.name, "must hold [[claim]] tables and nothing else")
    claims = []
    for index, table in enumerate(data["claim"]):
        name = table.get("id", f"number {index + 1}") if isinstance(table, dict) else str(index)
        try:
            claims.append(_CLAIMS.validate_python(table))
        except ValidationError as error:
            raise one_line(error, f"{path.name}: claim {name}") from None
    names = [claim.id for claim in claims]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{path.name}: claim.id", name, "stands twice; each claim has its own")
    return claims


def check_claims(claims: Sequence[Claim], findings: Findings) -> list[ClaimResult]:
    """Each claim's verdict, in their order."""
    from verify import exact_claims, measured_claims

    checks: dict[Any, Any] = {
        CriteriaClaim: _check_criteria,
        **exact_claims.CHECKS,
        **measured_claims.CHECKS,
    }
    return [checks[type(claim)](claim, findings) for claim in claims]


def result(
    claim: _Claim, verdict: Verdict, evidence: str, details: Sequence[Sequence[str]] = ()
) -> ClaimResult:
    """The result for a claim; `details` is a table whose first row is its head."""
    return ClaimResult(
        id=claim.id,
        source=claim.source,
        statement=claim.statement,
        scene=claim.scene,
        verdict=verdict,
        evidence=evidence,
        details=tuple(tuple(row) for row in details),
    )


def _check_criteria(claim: CriteriaClaim, findings: Findings) -> ClaimResult:
    scene = findings.scene(claim.scene)
    judged = [findings.criterion(scene, claim.scheme, n) for n in claim.numbers]
    verdicts = [c.verdict for c in judged]
    evidence = "; ".join(f"criterion {c.number}: {c.evidence}" for c in judged)
    if Verdict.REFUTED in verdicts:
        return result(claim, Verdict.REFUTED, evidence)
    if Verdict.UNDECIDED in verdicts:
        return result(claim, Verdict.UNDECIDED, evidence)
    weakest = Verdict.MEASURED if Verdict.MEASURED in verdicts else Verdict.PROVED
    return result(claim, weakest, evidence)
