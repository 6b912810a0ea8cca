"""What claims need computed, and nothing else: the tasks of their runs and proofs.

What algebra decides on the spot needs no task. Where a proof gives what a claim asks of a run,
that run is not made.
"""

from collections.abc import Mapping, Sequence

from verify.claims.growth import growth_tasks
from verify.claims.kinds import Claim, CriteriaClaim, FlowClaim, GrowthClaim
from verify.claims.regions import flow_tasks_of
from verify.claims.scenes import ON_RUNS
from verify.execution.plan import Plan
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.runs.run import proved_run
from verify.runs.task import RunTask
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene
from verify.studies.plan import grid_task, proof_task

_BY_PROOF_ALONE = (1, 2)  # criteria


def add_claims(
    plan: Plan, claims: Sequence[Claim], scenes: Mapping[str, Scene]
) -> dict[str, Frozen]:
    """Adds to the plan what the claims need; returns what needs no run, by the task's key.

    Raises InputError for a claim whose scene is not among them.
    """
    known: dict[str, Frozen] = {}
    for claim in claims:
        for task in _runs(claim, scenes):
            name = task.key
            found = known.get(name) or _without_a_run(task)
            if found is None:
                plan.need(task, f"claim {claim.id}")
            elif name not in plan.tasks:
                known[name] = found
                plan.leave_out(f"the run of claim {claim.id}", "a proof gives what it asks for")
        if isinstance(claim, FlowClaim) and claim.scene in scenes:
            for of_flow in flow_tasks_of(claim, scenes[claim.scene]):
                plan.need(of_flow, f"claim {claim.id}")
        if isinstance(claim, CriteriaClaim) and claim.scene in scenes:
            task_of_proof = proof_task(scenes[claim.scene], claim.scheme)
            plan.need(task_of_proof, f"claim {claim.id}")
    return known


def _runs(claim: Claim, scenes: Mapping[str, Scene]) -> list[RunTask]:
    if not isinstance(claim, ON_RUNS) or claim.scene not in scenes:
        return []
    scene = scenes[claim.scene]
    if isinstance(claim, GrowthClaim):
        return growth_tasks(scene, claim.scheme)
    if isinstance(claim, CriteriaClaim) and set(claim.numbers) <= set(_BY_PROOF_ALONE):
        return []
    if scene.grid is None:
        return []
    grid = scene.grid
    return [
        grid_task(scene, claim.scheme, h, start)
        for start in range(len(grid.initial_values))
        for h in grid.step_sizes
    ]


def _without_a_run(task: RunTask) -> Frozen | None:
    return proved_run(
        Hamiltonian.parse(task.hamiltonian, task.parameters),
        task.scheme,
        q=task.q,
        p=task.p,
        step_size=task.step_size,
        steps=task.steps,
        digits=task.digits,
        observables=task.observables,
    )
