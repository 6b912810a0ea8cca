"""Error against run time."""

from collections.abc import Callable
from fractions import Fraction
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from verify.errors import InputError
from verify.execution.keeper import Keeper
from verify.execution.plan import Plan, Results, Study, scene_name, toml_section
from verify.execution.task import HamiltonianTask
from verify.hamiltonians.run_domain import point_of
from verify.scenes.results.work_precision import WorkPrecisionResult
from verify.scenes.scene import Scene
from verify.scenes.values import Coordinates, ExactNumber, StepSize
from verify.studies.work_precision.peers import InitialValueProblem

if TYPE_CHECKING:
    from verify.studies.work_precision.ladder import SchemeErrors

_POINT_COST = 80_000_000  # float64 steps: a point takes some tenths of a second
_NOT_ASKED = "not asked for; `peers = true` in a scene asks, --peers in one line"


class WorkPrecisionTask(HamiltonianTask):
    """Error against run time of schemes over step sizes, of number systems, and of peers.

    `peers`: names of those that are drawn; `peers_left_out`: the others, each with the reason.
    """

    alone: ClassVar[bool] = True
    imports = ("verify.studies.work_precision.ladder",)
    result = WorkPrecisionResult
    kind: Literal["work_precision"] = "work_precision"
    schemes: tuple[str, ...]
    time: ExactNumber
    t0: ExactNumber = Fraction(0)
    step_sizes: tuple[StepSize, ...]
    q: Coordinates
    p: Coordinates
    repeats: int
    number_systems: tuple[str, ...]
    digits: tuple[int, ...]
    number_systems_scheme: str
    number_systems_step_size: StepSize
    peers: tuple[str, ...]
    peers_left_out: tuple[tuple[str, str], ...]

    @property
    def cost(self) -> int:
        """About the number of float64 steps that it is worth."""
        return _POINT_COST * len(self.schemes) * len(self.step_sizes)

    def prepare(self, advance: Callable[[int], None] = lambda _: None) -> "SchemeErrors":
        """Return the errors of the schemes, without timing; `advance` as in `measure`."""
        from verify.studies.work_precision.ladder import find_errors

        return find_errors(self._problem, self.schemes, self.step_sizes, advance)

    def compute(self, keeper: Keeper) -> WorkPrecisionResult:
        """Return the measured points as a result; the errors may be prepared."""
        return self.measure(lambda _: None, keeper.prepared)

    def measure(
        self, advance: Callable[[int], None], errors: "SchemeErrors | None" = None
    ) -> WorkPrecisionResult:
        """Measure as `compute` does; `advance` is called with the number of points just done.

        `errors`: those that `prepare` returned, computed here if they are left out.
        """
        from verify.studies.work_precision.measurement import work_precision

        scheme_errors = errors or self.prepare(advance)
        arguments = self.other_fields("q", "p", "time", "t0")
        return work_precision(self._problem, **arguments, errors=scheme_errors, advance=advance)

    @property
    def _problem(self) -> InitialValueProblem:
        hamiltonian = self.exact_hamiltonian()
        return InitialValueProblem(
            hamiltonian, point_of(hamiltonian, self.q, self.p), self.time, self.t0
        )


def work_precision_task(scene: Scene) -> WorkPrecisionTask:
    """Return the task of error against run time, of a scene that requests it.

    Raises InputError if peers are requested and not installed.
    """
    section = scene.work_precision
    assert section is not None  # noqa: S101 - the caller's condition
    schemes, sizes = section.schemes or scene.schemes, sorted(section.step_sizes, reverse=True)
    peers, left_out = _peers(section.peers)
    return WorkPrecisionTask.from_object(
        section,
        **scene.hamiltonian_fields(),
        **dict(section.initial_value),
        schemes=schemes,
        t0=scene.t0,
        step_sizes=tuple(sizes),
        number_systems_scheme=section.number_systems_scheme or schemes[0],
        number_systems_step_size=section.number_systems_step_size or sizes[len(sizes) // 2],
        peers=peers,
        peers_left_out=left_out,
    )


def _peers(requested: bool | None) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """Return the peers that are drawn, and the others with the reason why not."""
    from verify.studies.work_precision import peers

    names: list[str] = []
    left_out: list[tuple[str, str]] = []
    for name, library in peers.libraries().items():
        if requested is False:
            left_out.append((name, _NOT_ASKED))
        elif not (problem := _problem(library)):
            names.append(name)
        elif requested:
            raise InputError("work_precision.peers", "true", problem)
        else:
            left_out.append((name, problem))
    return tuple(names), tuple(left_out)


def _problem(library: str) -> str:
    """Return the reason why a peer of this library cannot be drawn; empty if it can."""
    is_installed = find_spec(library) is not None
    return "" if is_installed else f"{library} is not installed; the extra `peers` has it"


def _need(plan: Plan, scene: Scene) -> None:
    if scene.work_precision:
        task = work_precision_task(scene)
        plan.need(task, f"{scene_name(scene)}: error against run time")
        for peer, reason in task.peers_left_out:
            plan.leave_out(f"{scene_name(scene)}: {peer} beside the schemes", reason)


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    if scene.work_precision is None:
        return {}
    return {"work_precision": results[work_precision_task(scene).key]}


_SECTION = toml_section(6, "error against run time", "[work_precision]")
STUDY = Study(7, (_SECTION,), need=_need, results_for_scene=_collect)
