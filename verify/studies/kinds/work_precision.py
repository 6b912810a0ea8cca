"""Error against run time."""

from importlib.util import find_spec
from typing import Any

from verify.errors import InputError
from verify.execution.plan import Plan
from verify.execution.study import Results, Study, scene_name, toml_section
from verify.scenes.scene import Scene
from verify.studies.work_precision.task import WorkPrecisionTask

_NOT_ASKED = "not asked for; `peers = true` in a scene asks, --peers in one line"


def work_precision_task(scene: Scene) -> WorkPrecisionTask:
    """Return the task of error against run time, of a scene that requests it.

    Raises InputError where peers are requested and not installed.
    """
    section = scene.work_precision
    assert section is not None  # noqa: S101 - the caller's condition
    schemes, sizes = section.schemes or scene.schemes, sorted(section.step_sizes, reverse=True)
    peers, left_out = _peers(section.peers)
    return WorkPrecisionTask(
        **scene.hamiltonian_fields(),
        schemes=schemes,
        time=section.time,
        t0=scene.t0,
        step_sizes=tuple(sizes),
        q=section.initial_value.q,
        p=section.initial_value.p,
        repeats=section.repeats,
        number_systems=section.number_systems,
        digits=section.digits,
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
    """Return the reason why it cannot be drawn; empty where it can."""
    is_installed = find_spec(library) is not None
    return "" if is_installed else f"{library} is not installed; the extra `peers` has it"


def _need(plan: Plan, scene: Scene) -> None:
    if scene.work_precision:
        task = work_precision_task(scene)
        plan.need(task, f"{scene_name(scene)}: error against run time")
        for peer, why in task.peers_left_out:
            plan.leave_out(f"{scene_name(scene)}: {peer} beside the schemes", why)


def _collect(scene: Scene, results: Results) -> dict[str, Any]:
    if scene.work_precision is None:
        return {}
    return {"work_precision": results[work_precision_task(scene).key]}


_SECTION = toml_section(6, "error against run time", "[work_precision]")
STUDY = Study(7, (_SECTION,), need=_need, results_for_scene=_collect)
