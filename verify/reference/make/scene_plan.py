"""The tasks that a scene's reference sections need: orbits and exact flows, correctly rounded."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from typing import Any, Literal

from verify.arithmetic import automatic
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.run_domain import point_of
from verify.lockstep import Course, run_alone
from verify.reference.make.row_values import orbit_columns
from verify.runs.run_start import Start
from verify.scenes.frozen import Frozen
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.run_sections import Reference
from verify.scenes.scene import Scene
from verify.scenes.values import Coordinates, ExactNumber, StepSize
from verify.structures import AREA, SYMPLECTIC
from verify.studies.kinds.proofs import ProofTask, proof_task

ROW_COST = 1_000_000  # of a row of reference data, however few its steps
FLOW_ROW_COST = 10 * ROW_COST


class StepsTask(HamiltonianTask):
    """A request for numbers from an initial value, after each of these numbers of steps."""

    imports = ("verify.reference.make.orbit_computation",)
    step_size: StepSize
    q: Coordinates
    p: Coordinates
    t0: ExactNumber | None = None
    digits: int
    steps: tuple[int, ...]

    @property
    def inputs(self) -> dict[str, Any]:
        """Step size, initial value, t₀ and digits, as the files have them: in several degrees of
        freedom they have lists, and a t₀ of every H."""
        names = {"step_size", "q", "p", "t0", "digits"}
        if isinstance(self.q, Fraction) and self.t0 is None:
            names.remove("t0")
        return self.model_dump(include=names)


class OrbitTask(StepsTask):
    """A scheme's orbit after each of these numbers of steps, correctly rounded."""

    result = OrbitResult
    kind: Literal["orbit"] = "orbit"
    scheme: str

    @property
    def cost(self) -> int:
        return ROW_COST * len(self.steps) + automatic()[-1].cost * sum(self.steps)

    @property
    def ensemble(self) -> str | None:
        """Orbits of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    @property
    def orbit(self) -> Start:
        """The orbit of which these are points."""
        hamiltonian, t0 = self.exact_hamiltonian(), self.t0 or Fraction()
        point = point_of(hamiltonian, self.q, self.p)
        return Start(hamiltonian, self.scheme, self.step_size, point, t0)

    def compute(self, keeper: Keeper) -> OrbitResult:
        from verify.reference.make.orbit_computation import orbit_points

        return OrbitResult(points=run_alone(orbit_points(self.orbit, self.steps, self.digits)))

    def compute_in_turn(self, keeper: Keeper) -> Course[dict[str, Frozen]]:
        from verify.reference.make.orbit_computation import orbit_points

        points = yield from orbit_points(self.orbit, self.steps, self.digits)
        return {self.key: OrbitResult(points=points)}


class SolutionTask(StepsTask):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    result = SolutionResult
    kind: Literal["solution"] = "solution"

    @property
    def cost(self) -> int:
        return FLOW_ROW_COST * len(self.steps)

    def compute(self, keeper: Keeper) -> SolutionResult:
        from verify.reference.make.orbit_computation import solution_points

        hamiltonian, t0 = self.exact_hamiltonian(), self.t0 or Fraction()
        start = point_of(hamiltonian, self.q, self.p)
        times = {n: n * self.step_size for n in self.steps}
        points = solution_points(hamiltonian, start, t0, times, self.digits)
        return SolutionResult(points=tuple(points))


# -- the tasks of scenes --------------------------------------------------------------------------

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
    """Return the section's schemes; the scene's if it names none."""
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
    """Yield the tasks section by section, if the flow is requested: initial value, step size."""
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
