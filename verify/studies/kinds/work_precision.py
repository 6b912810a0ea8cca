"""Error against run time."""

from importlib.util import find_spec
from typing import Any

from verify.errors import InputError
from verify.execution.plan import Plan
from verify.execution.study import Results, Study, called, toml_section
from verify.scenes.scene import Scene
from verify.studies.work_precision.task import WorkPrecisionTask

_NOT_ASKED = "not asked for; `peers = true` in a scene asks, --peers in one line"


def work_precision_task(scene: Scene) -> WorkPrecisionTask:
    """Error against run time, of a scene that asks for it. Raises InputError where peers are wanted
    and not installed."""
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


def _peers(asked: bool | None) -> tuple[tuple[str, ...], tuple[tuple[str, str], ...]]:
    """Those that are drawn, and the others with the reason why not."""
    from verify.studies.work_precision import peers

    drawn: list[str] = []
    left_out: list[tuple[str, str]] = []
    for name, library in peers.libraries().items():
        if asked is False:
            left_out.append((name, _NOT_ASKED))
        elif not (problem := _problem(library)):
            drawn.append(name)
        elif asked:
            raise InputError("work_precision.peers", "true", problem)
        else:
            left_out.append((name, problem))
    return tuple(drawn), tuple(left_out)


def _problem(library: str) -> str:
    """Why it cannot be drawn; empty where it can."""
    installed = find_spec(library) is not None
    return "" if installed else f"{library} is not installed; the extra `peers` has it"


def _need(plan: Plan, scene: Scene) -> None:
    if scene.work_precision:
        task = work_precision_task(scene)
        plan.need(task, f"{called(scene)}: error against run time")
        for peer, why in task.peers_left_out:
            plan.leave_out(f"{called(scene)}: {peer} beside the schemes", why)


def _found(scene: Scene, results: Results) -> dict[str, Any]:
    if scene.work_precision is None:
        return {}
    return {"work_precision": results[work_precision_task(scene).key]}


_SECTION = toml_section(6, "error against run time", "[work_precision]")
STUDY = Study(7, (_SECTION,), need=_need, found=_found)
