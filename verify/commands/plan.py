"""The command `verify plan`: the tasks of a scene and their reasons, and what is left out.

A task is described by a line; its data are those of `verify.execution.plan.Plan.as_json`.
"""

from collections.abc import Callable, Mapping
from typing import Any

import click

from verify.commands.shared.input import SCENE, load_target
from verify.commands.shared.output import CommandAnswer, answering
from verify.prose import count

TaskData = Mapping[str, Any]  # the fields of a task as in JSON: numbers are texts


@click.command()
@click.argument("scene", type=SCENE, metavar="SCENE")
@answering
def plan(scene: str) -> CommandAnswer:
    """Show the tasks of SCENE with their reasons, and what is left out, with the reason.

    SCENE is a TOML file, `paper`, or a suite such as `stiff` or `extreme`. The processor time is
    estimated from the cost of each task, within a factor of four or so; several workers divide it.
    """
    from verify.studies.tasks_of_scenes import plan_scenes

    _, scenes, _ = load_target(scene)  # without the title and the claims
    plan_json = plan_scenes(scenes).as_json()
    return CommandAnswer(lambda: plan_json, lambda: _print(plan_json))


def _print(plan_json: dict[str, Any]) -> None:
    from verify.schemes.field_splitting import separate_parts

    task_count = count(len(plan_json["tasks"]), "task")
    click.echo(f"{task_count}, {_format_seconds(float(plan_json['seconds']))}")
    for task in plan_json["tasks"]:
        titled = {**task, "scheme": separate_parts(task.get("scheme", ""))[0]}
        click.echo(f"  {_DESCRIBERS[task['kind']](titled)} ({'; '.join(task['reasons'])})")
    click.echo(f"{len(plan_json['left_out'])} left out")
    for item in plan_json["left_out"]:
        click.echo(f"  {item['what']}: {item['why']}")


def _format_seconds(seconds: float) -> str:
    """Return the processor time in words: seconds are whole, longer times have one decimal place.

    >>> _format_seconds(9.42), _format_seconds(4200)
    ('about 9 s of processor time', 'about 1.2 h of processor time')
    """
    if seconds < 1:
        return "less than 1 s of processor time"
    _, unit_seconds, unit = next(row for row in _UNITS if seconds >= row[0])
    number = f"{seconds / unit_seconds:.0f}" if unit == "s" else f"{seconds / unit_seconds:.1f}"
    return f"about {number} {unit} of processor time"


# Units of time, the longest first: the least time, in seconds, that is written in the unit, the
# length of the unit in seconds, and its name.
_UNITS = ((2 * 86400, 86400, "days"), (3600, 3600, "h"), (120, 60, "min"), (1, 1, "s"))


def _describe_run(task: TaskData) -> str:
    point = task.get("start") or {"q": task["q"], "p": task["p"]}
    start = ", ".join(f"{name} = {x}" for name, x in point.items())
    # Tasks without a time of their own have no key, or none in it.
    start_time_text = f", t = {task['t0']}" if task.get("t0") not in (None, "0") else ""
    steps = f"{task['steps']} steps of {task['step_size']}"
    return f"{task['scheme']}, {steps} from {start}{start_time_text}"


def _describe_growth(task: TaskData) -> str:
    """Describe the task that finds the growth law of Λ, the cumulative area error."""
    orbit = f"the orbit from q = {task['q']}, p = {task['p']}"
    return f"growth law of Λ on {orbit} for {task['scheme']}"


def _describe_work_precision(task: TaskData) -> str:
    runs = f"{len(task['schemes'])} schemes at {len(task['step_sizes'])} step sizes"
    return f"error against run time of {runs} over [0, {task['time']}]"


def _describe_stability_map(task: TaskData) -> str:
    cells = len(task["values"]) * len(task["step_sizes"])
    return f"judge {task['scheme']} in {cells} cells of h and {task['parameter']}"


def _describe_flow(task: TaskData) -> str:
    shape = task["shape"]["shape"] or ("polygon" if task["shape"]["polygon"] else "path")
    return f"carry {shape} by {task['map']}, {task['steps']} steps of {task['step_size']}"


# The function that describes a task, by its kind. "separation" is that of Λ, in the plane;
# "separation in degrees" is that of W, in n degrees of freedom.
_DESCRIBERS: Mapping[str, Callable[[TaskData], str]] = {
    "keeps": lambda task: f"prove what {task['scheme']} keeps of {task['hamiltonian']}",
    "proof": lambda task: f"prove {task['scheme']} for H = {task['hamiltonian']}",
    "every": lambda task: f"prove {task['scheme']} for every H{' in time' * task['timed']}",
    "growth": _describe_growth,
    "work_precision": _describe_work_precision,
    "separation": lambda task: f"separate truncation from rounding in {_describe_run(task)}",
    "separation in degrees": lambda task: (
        f"separate truncation from rounding in {_describe_run(task)}"
    ),
    "run": lambda task: f"run {_describe_run(task)} in {task['arithmetic']}",
    "stability": lambda task: f"judge {_describe_run(task)}",
    "largest_step": lambda task: (
        f"bisect the largest step of {task['scheme']} until {task['time']}"
    ),
    "stability_map": _describe_stability_map,
    "orbit_map": lambda task: (
        f"step {task['scheme']} from {len(task['across']) * len(task['upwards'])} starts over "
        f"{' and '.join(task['axes'])}"
    ),
    "flow": _describe_flow,
    "poincare": lambda task: (
        f"follow {len(task['initial_values'])} orbits by {task['map']}, {task['steps']} steps of "
        f"{task['step_size']}, to where {task['coordinate']} passes {task['value']}"
    ),
    "stroboscopic": lambda task: (
        f"follow {len(task['initial_values'])} orbits by {task['scheme']}, {task['periods']} times "
        f"{task['steps']} steps of {task['step_size']}"
    ),
}
