"""A scene's reference sections → the tasks that they need.

The tasks of reference data: an orbit and the exact flow, every number correctly rounded.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import product
from typing import Any, ClassVar, Literal

from verify.arithmetic import automatic
from verify.arithmetic.exact import text
from verify.execution.keeping import Keeper
from verify.execution.plan import Plan
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.start import point_of
from verify.kernels.orbit import Orbit
from verify.scenes.results.reference import OrbitResult, SolutionResult
from verify.scenes.results.reference_in_degrees import OrbitInDegreesResult, SolutionInDegreesResult
from verify.scenes.scene import Scene
from verify.scenes.sections import Reference
from verify.scenes.values import Coordinates, Number, StepSize
from verify.studies.kinds.proofs import proof_task
from verify.studies.proofs.one import ProofTask

ROW_COST = 1_000_000  # of a row of reference data, however few its steps
FLOW_ROW_COST = 10 * ROW_COST


class AtSteps(HamiltonianTask):
    """What is asked for from an initial value, after each of these numbers of steps."""

    imports = ("verify.reference.make.orbit_points",)
    q: Coordinates
    p: Coordinates
    t0: Number | None = None
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int

    @property
    def inputs(self) -> dict[str, Any]:
        """Step size, initial value, t₀ and digits, as the files have them: in several degrees of
        freedom they have lists, and a t₀ of every H."""
        exact = {"step_size": self.step_size, "q": self.q, "p": self.p, "t0": self.t0}
        if isinstance(self.q, Fraction) and self.t0 is None:
            exact.pop("t0")
        return {**{name: _texts(x) for name, x in exact.items()}, "digits": self.digits}


def _texts(x: Fraction | tuple[Fraction, ...] | None) -> str | tuple[str, ...] | None:
    if x is None:
        return None
    return text(x) if isinstance(x, Fraction) else tuple(map(text, x))


class OrbitAtSteps(AtSteps):
    """A scheme's orbit after each of these numbers of steps, correctly rounded."""

    numbers: ClassVar[str]
    scheme: str

    @property
    def cost(self) -> int:
        return ROW_COST * len(self.steps) + automatic()[-1].cost * sum(self.steps)

    @property
    def orbit(self) -> Orbit:
        """What is run."""
        exact, t0 = self.exact_hamiltonian(), self.t0 or Fraction()
        return Orbit(exact, self.scheme, self.step_size, self.q, self.p, t0=t0)


class OrbitTask(OrbitAtSteps):
    """State, ΔJ, MSE and Λ."""

    result = OrbitResult
    numbers = "ΔJ, MSE and Λ"
    kind: Literal["orbit"] = "orbit"

    @property
    def ensemble(self) -> str | None:
        """Orbits of one scheme's map, whatever the step size and the initial value."""
        return f"{self.kind} {self.scheme} {self.hamiltonian}"

    def compute(self, keeper: Keeper) -> OrbitResult:
        from verify.reference.make.orbit_points import orbit_points

        points = orbit_points(self.orbit, self.steps, self.digits)
        return OrbitResult.model_validate({"points": tuple(points)})


class OrbitInDegreesTask(OrbitAtSteps):
    """State, H, S, W and Λ."""

    result = OrbitInDegreesResult
    numbers = "H, S, W and Λ"
    kind: Literal["orbit in degrees"] = "orbit in degrees"

    def compute(self, keeper: Keeper) -> OrbitInDegreesResult:
        from verify.reference.make.orbit_points import orbit_points

        points = orbit_points(self.orbit, self.steps, self.digits)
        return OrbitInDegreesResult.model_validate({"points": tuple(points)})


class SolutionAtSteps(AtSteps):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    @property
    def cost(self) -> int:
        return FLOW_ROW_COST * len(self.steps)

    @property
    def times(self) -> dict[str, Any]:
        """Where the exact flow begins, and the times after it by their N."""
        exact = self.exact_hamiltonian()
        after = {n: n * self.step_size for n in self.steps}
        start = point_of(exact, self.q, self.p)
        return {"hamiltonian": exact, "start": start, "t0": self.t0 or Fraction(), "times": after}


class SolutionTask(SolutionAtSteps):
    """p and q."""

    result = SolutionResult
    kind: Literal["solution"] = "solution"

    def compute(self, keeper: Keeper) -> SolutionResult:
        from verify.reference.make.orbit_points import solution_points

        points = solution_points(**self.times, digits=self.digits)
        return SolutionResult.model_validate({"points": tuple(points)})


class SolutionInDegreesTask(SolutionAtSteps):
    """p1 … pn, q1 … qn."""

    result = SolutionInDegreesResult
    kind: Literal["solution in degrees"] = "solution in degrees"

    def compute(self, keeper: Keeper) -> SolutionInDegreesResult:
        from verify.reference.make.orbit_points import solution_points

        points = solution_points(**self.times, digits=self.digits)
        return SolutionInDegreesResult.model_validate({"points": tuple(points)})


def plan_references(scenes: Sequence[Scene]) -> Plan:
    """What the scenes ask for of reference data, and nothing else of them.

    One task a proof, a run and a flow; those that two scenes share are one.
    """
    plan = Plan()
    for scene in scenes:
        name = scene.name or scene.title or "scene"
        for proof in proof_tasks(scene):
            plan.need(proof, f"{name}: orders and leading coefficients")
        for orbit in orbit_tasks(scene):
            plan.need(orbit, f"{name}: state, {orbit.numbers} at chosen steps")
        for solution in solution_tasks(scene):
            plan.need(solution, f"{name}: the exact flow at their times")
    return plan


def size_of(scene: Scene) -> int:
    """About how many bytes the file of its data will have, without listing what it asks for."""
    size, degrees = 0, scene.exact_hamiltonian().degrees
    for section in scene.reference:
        rows = len(section.initial_values) * len(section.step_sizes) * len(section.steps)
        numbers = 2 * degrees + (3 if degrees == 1 else 4)
        size += rows * len(schemes_of(scene, section)) * (numbers * section.digits + 300 * degrees)
        size += rows * section.flow * (2 * degrees * section.digits + 200 * degrees)
    return size


def schemes_of(scene: Scene, section: Reference) -> tuple[str, ...]:
    """The section's schemes; the scene's where it names none."""
    return section.schemes or scene.schemes


def proof_tasks(scene: Scene) -> Iterator[ProofTask]:
    """One a scheme that a section runs."""
    named = (name for section in scene.reference for name in schemes_of(scene, section))
    for name in dict.fromkeys(named):
        yield proof_task(scene, name, formulas=False)


def orbit_tasks(scene: Scene) -> Iterator[OrbitTask | OrbitInDegreesTask]:
    """Section by section: scheme, initial value, step size."""
    kind = OrbitTask if scene.exact_hamiltonian().planar else OrbitInDegreesTask
    for section in scene.reference:
        for scheme, given in product(schemes_of(scene, section), _starts(scene, section)):
            yield kind(scheme=scheme, **given)


def solution_tasks(scene: Scene) -> Iterator[SolutionTask | SolutionInDegreesTask]:
    """Section by section, where the flow is asked for: initial value, step size."""
    kind = SolutionTask if scene.exact_hamiltonian().planar else SolutionInDegreesTask
    for section in (x for x in scene.reference if x.flow):
        for given in _starts(scene, section):
            yield kind(**given)


def _starts(scene: Scene, section: Reference) -> Iterator[dict[str, Any]]:
    """What the tasks from each initial value with each step size have in common."""
    common = {"steps": section.steps, "digits": section.digits, **scene.hamiltonian_fields()}
    if scene.exact_hamiltonian().time_dependent:
        common["t0"] = scene.t0
    for at, h in product(section.initial_values, section.step_sizes):
        yield {"q": at.q, "p": at.p, "step_size": h, **common}
