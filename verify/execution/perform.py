"""One task → its result, by the kind of the task; what only one kind needs is imported for it."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from verify.algebra.formula import to_text
from verify.arithmetic.exact import text
from verify.execution.keeping import NOTHING, Keeper
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.order import prove
from verify.runs.run import run
from verify.scenes.results.core import (
    AverageResult,
    EveryResult,
    ProofResult,
    RunResult,
    SeparationResult,
)
from verify.scenes.results.exploration import ExploreResult, HuntResult, ShrunkResult
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.results.regions import FlowImage
from verify.scenes.results.stability import LargestStepResult, StabilityMapResult, StabilityResult
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.scenes.tasks import (
    EveryTask,
    ExploreTask,
    FlowTask,
    GrowthTask,
    HuntTask,
    LargestStepTask,
    OrbitTask,
    ProofTask,
    RunTask,
    SeparationTask,
    ShrinkTask,
    SolutionTask,
    StabilityMapTask,
    StabilityTask,
    Task,
    WorkPrecisionTask,
)
from verify.schemes import get
from verify.schemes.step_map import grouped
from verify.studies.separation.separate import separate

Result = (
    ProofResult
    | RunResult
    | SeparationResult
    | AverageResult
    | EveryResult
    | WorkPrecisionResult
    | StabilityResult
    | LargestStepResult
    | StabilityMapResult
    | FlowImage
    | OrbitResult
    | SolutionResult
    | ExploreResult
    | ShrunkResult
    | HuntResult
)


def perform(task: Task, keeper: Keeper = NOTHING) -> Result:
    """Do one task; a run goes on from the checkpoint that the keeper may have."""
    return KINDS[task.kind].do(task, keeper)


def result_model(task: Task) -> type[Result]:
    """The model of the task's result."""
    return KINDS[task.kind].model


def _given(task: Any) -> Hamiltonian:
    return Hamiltonian.parse(task.hamiltonian, task.parameters)


def _run(task: RunTask, keeper: Keeper) -> RunResult:
    return run(
        _given(task),
        task.scheme,
        q=task.q,
        p=task.p,
        step_size=task.step_size,
        steps=task.steps,
        arithmetic=task.arithmetic,
        digits=task.digits,
        observables=task.observables,
        points=task.points,
        keeper=keeper,
    )


def _separation(task: SeparationTask, keeper: Keeper) -> SeparationResult:
    return separate(
        _given(task),
        task.scheme,
        q=task.q,
        p=task.p,
        step_size=task.step_size,
        steps=task.steps,
        digits=task.digits,
        keeper=keeper,
    )


def _growth(task: GrowthTask, _: Keeper) -> AverageResult:
    from verify.studies.growth_law import average_of

    return average_of(_given(task), task.scheme, q=task.q, p=task.p, digits=task.digits)


def _work_precision(task: WorkPrecisionTask, _: Keeper) -> WorkPrecisionResult:
    from verify.studies.work_precision.measure import work_precision

    return work_precision(_given(task), task)


def _flow(task: FlowTask, _: Keeper) -> FlowImage:
    from verify.studies.regions.carry import carry

    return carry(_given(task), task)


def _orbit(task: OrbitTask, _: Keeper) -> OrbitResult:
    from verify.reference.make.orbit_points import orbit

    return orbit(_given(task), task)


def _solution(task: SolutionTask, _: Keeper) -> SolutionResult:
    from verify.reference.make.orbit_points import solution

    return solution(_given(task), task)


def _explore(task: ExploreTask, _: Keeper) -> ExploreResult:
    from verify.exploration.explore import look

    return look(task)


def _shrink(task: ShrinkTask, _: Keeper) -> ShrunkResult:
    from verify.exploration.explore import shrink

    return shrink(task)


def _hunt(task: HuntTask, _: Keeper) -> HuntResult:
    from verify.exploration.hunting import search

    return search(task)


def _stability(task: StabilityTask, _: Keeper) -> StabilityResult:
    from verify.studies.stability.tasks import judged

    return judged(_given(task), task)


def _largest_step(task: LargestStepTask, _: Keeper) -> LargestStepResult:
    from verify.studies.stability.tasks import largest

    return largest(_given(task), task)


def _stability_map(task: StabilityMapTask, _: Keeper) -> StabilityMapResult:
    from verify.studies.stability.tasks import mapped

    return mapped(_given(task), task)


def _proof(task: ProofTask, _: Keeper) -> ProofResult:
    hamiltonian, scheme = _given(task), task.scheme
    begun = time.perf_counter()
    step_map = get(scheme).step_map(hamiltonian)
    proof = prove(step_map, get(scheme))
    closed, p_next, q_next, jacobian = step_map.closed, None, None, None
    if closed is not None and task.formulas:
        written = (closed.p_next, closed.q_next, *closed.jacobian)
        p_next, q_next, a, b, c, d = (to_text(grouped(closed.ring, x)) for x in written)
        jacobian = (a, b), (c, d)
    return ProofResult(
        **hamiltonian.written,
        scheme=scheme,
        verdict=proof.verdict,
        reason=proof.reason,
        order=proof.order,
        leading=proof.first.text,
        delta_j=step_map.delta_j_text if task.formulas else None,
        area_preserving=proof.area_preserving,
        convergence_order=proof.convergence_order,
        witness={name: text(value) for name, value in proof.witness.items()},
        enclosure=proof.enclosure,
        p_next=p_next,
        q_next=q_next,
        jacobian=jacobian,
        seconds=time.perf_counter() - begun,
    )


def _every(task: EveryTask, _: Keeper) -> EveryResult:
    from verify.proof.every import prove_every

    proof = prove_every(task.scheme)
    return EveryResult(
        **{name: getattr(proof, name) for name in EveryResult.model_fields},
    )


@dataclass(frozen=True)
class Kind:
    """How tasks of one kind are done, and the model of what they give."""

    do: Callable[[Any, Keeper], Result]
    model: type[Result]


KINDS: dict[str, Kind] = {
    "proof": Kind(_proof, ProofResult),
    "run": Kind(_run, RunResult),
    "separation": Kind(_separation, SeparationResult),
    "growth": Kind(_growth, AverageResult),
    "every": Kind(_every, EveryResult),
    "stability": Kind(_stability, StabilityResult),
    "largest_step": Kind(_largest_step, LargestStepResult),
    "stability_map": Kind(_stability_map, StabilityMapResult),
    "flow": Kind(_flow, FlowImage),
    "orbit": Kind(_orbit, OrbitResult),
    "solution": Kind(_solution, SolutionResult),
    "explore": Kind(_explore, ExploreResult),
    "shrink": Kind(_shrink, ShrunkResult),
    "hunt": Kind(_hunt, HuntResult),
    "work_precision": Kind(_work_precision, WorkPrecisionResult),
}
