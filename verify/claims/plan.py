"""What claims need computed, and nothing else: the tasks of their runs and proofs.

What algebra decides on the spot needs no task. Where a proof gives what a claim asks of a run,
that run is not made.
"""

from collections.abc import Mapping, Sequence

from verify.claims.claim import Claim
from verify.execution.plan import Plan
from verify.scenes.frozen import Frozen
from verify.scenes.scene import Scene


def add_claims(
    plan: Plan, claims: Sequence[Claim], scenes: Mapping[str, Scene]
) -> dict[str, Frozen]:
    """Adds to the plan what the claims need; returns what needs no run, by the task's key.

    A claim whose scene is not among them needs what it does without one.
    """
    known: dict[str, Frozen] = {}
    for claim in claims:
        own = scenes.get(claim.scene)
        for task in claim.tasks_without_scene() if own is None else claim.tasks(own):
            name = task.key
            found = known.get(name) or task.proved()
            if found is None:
                plan.need(task, f"claim {claim.id}")
            elif name not in plan.tasks:
                known[name] = found
                plan.leave_out(f"the run of claim {claim.id}", "a proof gives what it asks for")
    return known
