"""The command `verify plan`: what a scene needs computed, what is left out, and why."""

from collections.abc import Callable, Mapping
from typing import Any

import click

from verify.commands.shared.input import SCENE, load_target
from verify.commands.shared.output import CommandAnswer, answering
from verify.prose import count

Task = Mapping[str, Any]  # as JSON has it


@click.command()
@click.argument("scene", type=SCENE, metavar="SCENE")
@answering
def plan(scene: str) -> CommandAnswer:
    """Show what SCENE needs computed, what is left out, and why.

    SCENE is a TOML file, `paper`, `stiff` or `extreme`. The processor time is estimated by what
    such tasks cost, within a factor of four or so; workers share it.
    """
    from verify.studies.tasks_of_scenes import plan_scenes

    _, scenes, _ = load_target(scene)
    planned = plan_scenes(scenes).as_json()
    return CommandAnswer(lambda: planned, lambda: _print(planned))


def _print(planned: dict[str, Any]) -> None:
    tasks = count(len(planned["tasks"]), "task")
    click.echo(f"{tasks}, {_format_seconds(float(planned['seconds']))}")
    for task in planned["tasks"]:
        click.echo(f"  {_LINES[task['kind']](task)} ({'; '.join(task['reasons'])})")
    click.echo(f"{len(planned['left_out'])} left out")
    for item in planned["left_out"]:
        click.echo(f"  {item['what']}: {item['why']}")


def _format_seconds(seconds: float) -> str:
    """Return the processor time in words, to one digit or two.

    >>> _format_seconds(9.42), _format_seconds(4200)
    ('about 9 s of processor time', 'about 1.2 h of processor time')
    """
    if seconds < 1:
        return "less than 1 s of processor time"
    _, size, unit = next(entry for entry in _UNITS if seconds >= entry[0])
    number = f"{seconds / size:.0f}" if unit == "s" else f"{seconds / size:.1f}"
    return f"about {number} {unit} of processor time"


_UNITS = ((2 * 86400, 86400, "days"), (3600, 3600, "h"), (120, 60, "min"), (1, 1, "s"))


def _describe_run(task: Task) -> str:
    start = f"q = {task['q']}, p = {task['p']}"
    late = f", t = {task['t0']}" if task.get("t0", "0") != "0" else ""
    return f"{task['scheme']}, {task['steps']} steps of {task['step_size']} from {start}{late}"


def _describe_growth(task: Task) -> str:
    orbit = f"the orbit from q = {task['q']}, p = {task['p']}"
    return f"growth law of Λ on {orbit} for {task['scheme']}"


def _describe_work_precision(task: Task) -> str:
    runs = f"{len(task['schemes'])} schemes at {len(task['step_sizes'])} step sizes"
    return f"error against run time of {runs} over [0, {task['time']}]"


def _describe_map(task: Task) -> str:
    cells = len(task["values"]) * len(task["step_sizes"])
    return f"judge {task['scheme']} in {cells} cells of h and {task['parameter']}"


def _describe_flow(task: Task) -> str:
    shape = task["shape"]["shape"] or ("polygon" if task["shape"]["polygon"] else "path")
    return f"carry {shape} by {task['map']}, {task['steps']} steps of {task['step_size']}"


_LINES: Mapping[str, Callable[[Task], str]] = {
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
    "stability_map": _describe_map,
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
