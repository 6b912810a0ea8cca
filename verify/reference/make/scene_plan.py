"""A scene's reference sections → the tasks that they need."""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

from verify.execution.plan import Plan
from verify.reference.make.columns import orbit_columns
from verify.reference.make.tasks import OrbitTask, SolutionTask
from verify.scenes.run_sections import Reference
from verify.scenes.scene import Scene
from verify.structures import AREA, SYMPLECTIC
from verify.studies.kinds.proofs import proof_task
from verify.studies.proofs.one import ProofTask

_NUMBERS = {AREA: "ΔJ, MSE and Λ", SYMPLECTIC: "H, S, W and Λ"}


def plan_references(scenes: Sequence[Scene]) -> Plan:
    """Plan the reference data that the scenes request, and nothing else of them.

    One task for a proof, a run and a flow; those that two scenes share are one.
    """
    plan = Plan()
    for scene in scenes:
        name = scene.name or scene.title or "scene"
        numbers = _NUMBERS[scene.exact_hamiltonian().structure]
        for proof in proof_tasks(scene):
            plan.need(proof, f"{name}: orders and leading coefficients")
        for orbit in orbit_tasks(scene):
            plan.need(orbit, f"{name}: state, {numbers} at chosen steps")
        for solution in solution_tasks(scene):
            plan.need(solution, f"{name}: the exact flow at their times")
    return plan


def size_of(scene: Scene) -> int:
    """Estimate the bytes of the file of its data, without listing what the scene requests."""
    size, degrees = 0, scene.exact_hamiltonian().degrees
    for section in scene.reference:
        rows = len(section.initial_values) * len(section.step_sizes) * len(section.steps)
        numbers = 2 * degrees + len(orbit_columns(degrees))
        size += rows * len(schemes_of(scene, section)) * (numbers * section.digits + 300 * degrees)
        size += rows * section.flow * (2 * degrees * section.digits + 200 * degrees)
    return size


def schemes_of(scene: Scene, section: Reference) -> tuple[str, ...]:
    """Return the section's schemes; the scene's where it names none."""
    return section.schemes or scene.schemes


def proof_tasks(scene: Scene) -> Iterator[ProofTask]:
    """Yield one task for each scheme that a section runs."""
    names = (name for section in scene.reference for name in schemes_of(scene, section))
    for name in dict.fromkeys(names):
        yield proof_task(scene, name, formulas=False)


def orbit_tasks(scene: Scene) -> Iterator[OrbitTask]:
    """Yield the tasks section by section: scheme, initial value, step size."""
    for section in scene.reference:
        for scheme, start in product(schemes_of(scene, section), _starts(scene, section)):
            yield OrbitTask(scheme=scheme, **start)


def solution_tasks(scene: Scene) -> Iterator[SolutionTask]:
    """Yield the tasks section by section, where the flow is requested: initial value, step size."""
    for section in (x for x in scene.reference if x.flow):
        for start in _starts(scene, section):
            yield SolutionTask(**start)


def _starts(scene: Scene, section: Reference) -> Iterator[dict[str, Any]]:
    """Yield the fields that the tasks from each initial value with each step size share."""
    common = {"steps": section.steps, "digits": section.digits, **scene.hamiltonian_fields()}
    if scene.exact_hamiltonian().time_dependent:
        common["t0"] = scene.t0
    for start, h in product(section.initial_values, section.step_sizes):
        yield {"q": start.q, "p": start.p, "step_size": h, **common}
