"""The kinds of task, each with all that its result depends on."""

import hashlib
import json
from typing import ClassVar, Literal

from verify.scenes.region_sections import ShapeGiven
from verify.scenes.results.core import Frozen
from verify.scenes.values import Number, StepSize


class _Task(Frozen):
    """`alone`: it measures run times, so that nothing else may run beside it."""

    alone: ClassVar[bool] = False


class _OfHamiltonian(_Task):
    """H as its formula, with its parameter values."""

    hamiltonian: str
    parameters: dict[str, Number]


class _OfScheme(_OfHamiltonian):
    scheme: str


class _FromPoint(_OfScheme):
    """One scheme from one initial value."""

    q: Number
    p: Number


class ProofTask(_OfScheme):
    """Prove the order of ΔJ and of the map for one H and one scheme.

    `formulas`: ΔJ, the map and its Jacobian are also written out, which may take longer.
    """

    kind: Literal["proof"] = "proof"
    formulas: bool = True


class RunTask(_FromPoint):
    """Run N steps and report the observables."""

    kind: Literal["run"] = "run"
    step_size: StepSize
    steps: int
    arithmetic: str
    digits: int
    observables: tuple[str, ...]
    points: int


class SeparationTask(_FromPoint):
    """Split Λ of a float64 run into truncation and rounding."""

    kind: Literal["separation"] = "separation"
    step_size: StepSize
    steps: int
    digits: int


class GrowthTask(_FromPoint):
    """The growth law of Λ on one orbit, with the time average in it."""

    kind: Literal["growth"] = "growth"
    digits: int


class EveryTask(_Task):
    """What is proved of a scheme for every H."""

    kind: Literal["every"] = "every"
    scheme: str


class WorkPrecisionTask(_OfHamiltonian):
    """Error against run time of schemes over step sizes, of number systems, and of peers.

    `peers`: names of those that are drawn; `peers_left_out`: the others, each with the reason.
    """

    alone: ClassVar[bool] = True
    kind: Literal["work_precision"] = "work_precision"
    schemes: tuple[str, ...]
    time: Number
    step_sizes: tuple[StepSize, ...]
    q: Number
    p: Number
    repeats: int
    number_systems: tuple[str, ...]
    digits: tuple[int, ...]
    number_systems_scheme: str
    number_systems_step_size: StepSize
    peers: tuple[str, ...]
    peers_left_out: tuple[tuple[str, str], ...]


class StabilityTask(_FromPoint):
    """Judge one run: stable, drifting, unstable, and whose fault it is."""

    kind: Literal["stability"] = "stability"
    step_size: StepSize
    steps: int


class LargestStepTask(_FromPoint):
    """The largest step size with bounded motion until `time`."""

    kind: Literal["largest_step"] = "largest_step"
    time: Number


class StabilityMapTask(_FromPoint):
    """Verdicts over a parameter's values and step sizes."""

    kind: Literal["stability_map"] = "stability_map"
    parameter: str
    values: tuple[Number, ...]
    step_sizes: tuple[StepSize, ...]
    steps: int


class FlowTask(_OfHamiltonian):
    """Carry a shape by `steps` steps of a map: a scheme's, or the exact flow's."""

    kind: Literal["flow"] = "flow"
    map: str
    shape: ShapeGiven
    step_size: StepSize
    steps: int
    digits: int
    mean_lambda: bool
    distance: bool


class OrbitTask(_FromPoint):
    """State, ΔJ, MSE and Λ after each of these numbers of steps, correctly rounded."""

    kind: Literal["orbit"] = "orbit"
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int


class SolutionTask(_OfHamiltonian):
    """The exact flow at the times N·h for each of these N, correctly rounded."""

    kind: Literal["solution"] = "solution"
    q: Number
    p: Number
    step_size: StepSize
    steps: tuple[int, ...]
    digits: int


class Drawn(Frozen):
    """From what scenes are drawn: these kinds of H up to a degree, these schemes (empty: all)."""

    kinds: tuple[str, ...] = ()
    degree: int = 6
    schemes: tuple[str, ...] = ()


class _OfDrawn(_Task):
    drawn: Drawn
    seed: int


class _OfProperties(_OfDrawn):
    """`properties`: names of the catalogue; `claims`: claims to be looked at so, each as JSON."""

    properties: tuple[str, ...]
    claims: tuple[str, ...]


class ExploreTask(_OfProperties):
    """Hold properties against `count` drawn scenes: those of this seed from number `first` on."""

    kind: Literal["explore"] = "explore"
    first: int
    count: int


class ShrinkTask(_OfProperties):
    """Shrink one drawn scene for which a property (the only one given) does not hold."""

    kind: Literal["shrink"] = "shrink"
    example: int


class HuntTask(_OfDrawn):
    """Search one island for scenes that make a measure as large as can be."""

    kind: Literal["hunt"] = "hunt"
    measure: str
    island: int
    count: int
    steps: int


Task = (
    ProofTask
    | RunTask
    | SeparationTask
    | GrowthTask
    | EveryTask
    | WorkPrecisionTask
    | StabilityTask
    | LargestStepTask
    | StabilityMapTask
    | FlowTask
    | OrbitTask
    | SolutionTask
    | ExploreTask
    | ShrinkTask
    | HuntTask
)


def key(task: Task) -> str:
    """A name for the task by its content."""
    content = json.dumps(task.model_dump(mode="json"), sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()[:24]
