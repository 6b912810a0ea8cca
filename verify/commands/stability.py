"""The command `verify stability`: the runs of a scene, judged, and linear theory, exactly."""

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import Answer
from verify.commands.shared.linear_theory import linear_answer
from verify.commands.shared.one_line import scenes_of, start_options, with_one_line
from verify.commands.shared.output import print_once
from verify.commands.shared.tasks import perform, with_tasks
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.studies.stability.findings import StabilityFindings

_PLAIN = ("stable", "drifts")  # verdicts that say all there is
_WIDTH, _IN = 100, " " * 6


@click.command()
@with_one_line(
    click.option("--steps", type=int, metavar="N", help="At least 1; or:"),
    click.option("--time", metavar="T", help="N is T/H rounded down."),
)
@start_options
@click.option(
    "--linear",
    is_flag=True,
    help="One scheme on the harmonic oscillator, or at an equilibrium of H, by algebra.",
)
@with_tasks
def stability(
    scene: str | None, linear: bool, keep: Path | None, where: "Placement", **given: Any
) -> Answer:
    """Judge the runs of SCENE: a TOML file, `paper`, or the suites `stiff` and `extreme`.

    stable, drifts, unstable: scheme, unstable: arithmetic, escapes, overflow at step k, underflow;
    in n degrees of freedom sensitive, where the exact motion parts from its neighbours itself.
    Nothing of the scene is done but its [[stability]], [[largest_step]], [[stability_map]] and
    [[orbit_map]].

    \b
    verify stability stiff
    verify stability --system pendulum --scheme lie2 --step-size 0.1 --time 100 --q 1 --p 0
    verify stability --linear --scheme lie4
    verify stability --linear --scheme rk4 --system fput --param n=8 --param alpha=1 --param beta=0
    """
    if linear:
        return linear_answer(scene, given)
    from verify.execution.study import plan_of
    from verify.scenes.values import rounded_down
    from verify.studies.stability.findings import findings_of
    from verify.studies.stability.plan import need_stability

    scenes = scenes_of(scene, given, ("q", "p"), _section)
    plan = plan_of(scenes, need_stability)
    if not plan.tasks:
        problem = "asks for no [[stability]], [[largest_step]], [[stability_map]] or [[orbit_map]]"
        raise InputError("SCENE", scene or NOT_GIVEN, problem)
    found = findings_of(scenes, perform(plan, keep, where))
    notes = [
        rounded_down(section.time, section.step_sizes)
        for each in scenes
        for section in each.stability
    ]

    def shown() -> None:
        _print(found)
        print_once(notes)

    return Answer(found.as_json, shown)


def _section(*, q: Any, p: Any, **rest: Any) -> dict[str, Any]:
    return {"stability": [{**rest, "initial_values": [{"q": q, "p": p}]}]}


def _print(found: "StabilityFindings") -> None:
    width = max((len(run.verdict) for run in found.runs), default=0)
    for run in found.runs:
        click.echo(f"{run.verdict:{width}}  {run.id}")
        if run.kind not in _PLAIN:
            detail = textwrap.fill(run.detail, _WIDTH, initial_indent=_IN, subsequent_indent=_IN)
            click.echo(detail)
    for step in found.largest_steps:
        measured, detail = f"bounded up to h = {step.bounded}", str(step.detail)
        if step.bounded is None:
            measured = "never bounded"
        elif step.unbounded is None:
            measured, detail = f"{detail}, the largest h = {step.bounded},", ""
        linear = f"linear theory {step.linear}" if step.linear else "linear theory sets no limit"
        within = [f"energy error ≤ {step.energy_error}"] * bool(step.energy_error)
        within += [f"|W| ≤ {step.symplectic_defect}"] * bool(step.symplectic_defect)
        with_ = f" with {' and '.join(within)}" if within else ""
        said = f"{measured}{with_} until t = {step.time}; {linear}  {detail}"
        click.echo(f"{step.scheme}: {said}")
    for over in found.maps:
        counted = ", ".join(f"{n} {kind}" for kind, n in over.counted().items())
        click.echo(f"{over.scheme}: {over.parameter} and step size: {counted}")
    for starts in found.orbit_maps:
        counted = ", ".join(f"{n} {kind}" for kind, n in starts.counted().items())
        click.echo(f"{starts.scheme}: orbits over {' and '.join(starts.axes)}: {counted}")
