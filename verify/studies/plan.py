"""What is asked → what is needed: tasks, each once, with reasons; and what is left out and why."""

from collections.abc import Callable
from fractions import Fraction

from verify.arithmetic.exact import text
from verify.execution.plan import Plan
from verify.runs.task import RunTask
from verify.scenes.scene import Grid, Scene
from verify.scenes.values import CLOSED_FORM
from verify.schemes import get
from verify.studies.growth.task import GrowthTask
from verify.studies.proofs.every import EveryTask
from verify.studies.proofs.one import ProofTask
from verify.studies.regions.plan import need_flows
from verify.studies.separation.task import SeparationTask
from verify.studies.stability.plan import need_stability
from verify.studies.work_precision.plan import work_precision_task

SEPARATED_DIGITS = 6  # of each part
AVERAGE_DIGITS = 30


def plan_scenes(scenes: list[Scene]) -> Plan:
    """The tasks of all scenes; a task that several ask for is done once."""
    plan = Plan()
    for scene in scenes:
        _plan_scene(plan, scene)
    return plan


def proof_task(scene: Scene, scheme: str, *, formulas: bool = True) -> ProofTask:
    """The proof of one scheme for the scene's H; `formulas`: with ΔJ in closed form."""
    return ProofTask(**scene.hamiltonian_fields(), scheme=scheme, formulas=formulas)


def grid_task(scene: Scene, scheme: str, h: Fraction, start: int) -> RunTask:
    """The grid's run for a step size and the index of an initial value."""
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    grid, at = scene.grid, scene.grid.initial_values[start]
    return RunTask(
        **scene.hamiltonian_fields(), scheme=scheme,
        step_size=h, steps=grid.steps_for(h), q=at.q, p=at.p, arithmetic=grid.arithmetic,
        digits=grid.digits, observables=grid.observables, points=0,
    )  # fmt: skip


def separation_task(
    scene: Scene, scheme: str, grid: Grid, h: Fraction, start: int
) -> SeparationTask:
    """The split of the grid's run for a step size and the index of an initial value."""
    at = grid.initial_values[start]
    return SeparationTask(
        **scene.hamiltonian_fields(), scheme=scheme,
        step_size=h, steps=grid.steps_for(h), q=at.q, p=at.p, digits=SEPARATED_DIGITS,
    )  # fmt: skip


def growth_task(scene: Scene, scheme: str, start: int) -> GrowthTask:
    """The growth law for the index of an initial value of the grid."""
    assert scene.grid is not None  # noqa: S101 - asked for by grids only
    at = scene.grid.initial_values[start]
    return GrowthTask(
        **scene.hamiltonian_fields(), scheme=scheme,
        q=at.q, p=at.p, digits=AVERAGE_DIGITS,
    )  # fmt: skip


def grids_separated(scene: Scene) -> list[Grid]:
    """The grids whose runs are separated: the scene's own where it says so, then the others."""
    own = [scene.grid] if scene.grid and scene.grid.separate else []
    return own + [over.as_grid() for over in scene.separation]


def series_task(scene: Scene, scheme: str, index: int) -> RunTask:
    """The run of the scene's series of that index."""
    series = scene.series[index]
    at = series.initial_value
    return RunTask(
        **scene.hamiltonian_fields(), scheme=scheme,
        step_size=series.step_size, steps=series.count, q=at.q, p=at.p,
        arithmetic=series.arithmetic, digits=series.digits, observables=CLOSED_FORM,
        points=series.points,
    )  # fmt: skip


def _plan_scene(plan: Plan, scene: Scene) -> None:
    name = scene.name or scene.title or "scene"
    for scheme in scene.schemes:
        plan.need(proof_task(scene, scheme), f"{name}: closed form and order of ΔJ")
        if scene.every_hamiltonian:
            _plan_every(plan, name, scheme)
        step_map = get(scheme).step_map(scene.exact_hamiltonian())
        preserves = step_map.preserves_area
        if scene.grid:
            _plan_grid(plan, scene, scheme, preserves)
            _plan_growth(plan, scene, scheme, preserves)
        for grid in grids_separated(scene):
            _plan_separation(plan, scene, scheme, grid, preserves)
        for index, series in enumerate(scene.series):
            what = f"{name}: series of {scheme} at h = {text(series.step_size)}"
            if preserves:
                plan.leave_out(what, "ΔJ ≡ 0 is proved: it is a line at 0")
            else:
                plan.need(series_task(scene, scheme, index), f"{what}, for its plot")
    if scene.work_precision:
        task = work_precision_task(scene, scene.work_precision)
        plan.need(task, f"{name}: error against run time")
        for peer, why in task.peers_left_out:
            plan.leave_out(f"{name}: {peer} beside the schemes", why)
    need_flows(plan, scene)
    need_stability(plan, scene)
    if scene.reference:
        plan.leave_out(f"{name}: reference data", "`verify reference make` makes it")
    for what, why, asked in _SECTIONS:
        if not asked(scene):
            plan.leave_out(f"{name}: {what}", why)


# What a scene may ask for: what it is, why it is left out, and whether the scene asks for it.
_SECTIONS: tuple[tuple[str, str, Callable[[Scene], object]], ...] = (
    (
        "proofs for every H",
        "the scene does not say `every_hamiltonian = true`",
        lambda scene: scene.every_hamiltonian,
    ),
    ("runs over step sizes", "the scene has no [grid]", lambda scene: scene.grid),
    (
        "truncation separated from rounding",
        "the scene has no [[separation]], and its [grid] does not say `separate = true`",
        grids_separated,
    ),
    (
        "Λ against its growth law",
        "the scene has no [grid] that says `growth = true`",
        lambda scene: scene.grid and scene.grid.growth,
    ),
    (
        "trajectories and plots over time",
        "the scene has no [[series]]",
        lambda scene: scene.series,
    ),
    ("criteria 1–4", "the scene names no criteria", lambda scene: scene.criteria),
    (
        "error against run time",
        "the scene has no [work_precision]",
        lambda scene: scene.work_precision,
    ),
    (
        "regions carried by maps, and their areas",
        "the scene has no [[flow]]",
        lambda scene: scene.flow,
    ),
    (
        "stability, and whose fault it is where there is none",
        "the scene has no [[stability]]",
        lambda scene: scene.stability,
    ),
    (
        "the largest stable step",
        "the scene has no [[largest_step]]",
        lambda scene: scene.largest_step,
    ),
    (
        "the map of step size and stiffness",
        "the scene has no [[stability_map]]",
        lambda scene: scene.stability_map,
    ),
)


def _plan_every(plan: Plan, name: str, scheme: str) -> None:
    if get(scheme).every_h is None:
        plan.leave_out(f"{name}: {scheme} for every H", "it is given for one H")
    else:
        plan.need(EveryTask(scheme=scheme), f"{name}: what holds for every H")


def _plan_separation(plan: Plan, scene: Scene, scheme: str, grid: Grid, preserves: bool) -> None:
    name = scene.name or scene.title or "scene"
    if preserves:
        why = "ΔJ ≡ 0 is proved: the truncation part is exactly 0"
        plan.leave_out(f"{name}: truncation separated from rounding for {scheme}", why)
        return
    for start in range(len(grid.initial_values)):
        for h in grid.step_sizes:
            task = separation_task(scene, scheme, grid, h, start)
            plan.need(task, f"{name}: truncation separated from rounding in Λ")


def _plan_growth(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name, grid = scene.name or scene.title or "scene", scene.grid
    if grid is None or not grid.growth:
        return
    if preserves:
        why = "ΔJ ≡ 0 is proved: Λ is exactly 0"
        plan.leave_out(f"{name}: growth law of Λ for {scheme}", why)
        return
    for start in range(len(grid.initial_values)):
        plan.need(growth_task(scene, scheme, start), f"{name}: growth law of Λ")


def _plan_grid(plan: Plan, scene: Scene, scheme: str, preserves: bool) -> None:
    name, grid = scene.name or scene.title or "scene", scene.grid
    assert grid is not None  # noqa: S101 - the caller's condition
    if preserves and set(grid.observables) <= set(CLOSED_FORM):
        plan.leave_out(
            f"{name}: {len(grid.step_sizes) * len(grid.initial_values)} runs of {scheme}",
            "ΔJ ≡ 0 is proved: ΔJ, MSE and Λ are exactly 0",
        )
        return
    for start in range(len(grid.initial_values)):
        for h in grid.step_sizes:
            plan.need(grid_task(scene, scheme, h, start), f"{name}: grid")
