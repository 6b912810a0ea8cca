"""The command `verify stability`: the runs of a scene, judged, and linear theory, exactly."""

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared.answer import Answer
from verify.commands.shared.input import SCHEME, target
from verify.commands.shared.tasks import perform, with_tasks
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.studies.stability.findings import StabilityFindings
    from verify.studies.stability.linear import LinearStability

_PLAIN = ("stable", "drifts")  # verdicts that say all there is
_WIDTH, _IN = 100, " " * 6


@click.command()
@click.argument("scene", required=False, metavar="[SCENE]")
@click.option("--linear", is_flag=True, help="On the harmonic oscillator, by exact algebra.")
@click.option(
    "--scheme",
    type=SCHEME,
    metavar="NAME",
    help="With --linear: lie1, lie2, …, stormer-verlet, rk4, …",
)
@with_tasks
def stability(
    scene: str | None,
    linear: bool,
    scheme: str | None,
    keep: Path | None,
    where: "Placement",
) -> Answer:
    """Judge the runs of SCENE: a TOML file, `paper`, or the suites `stiff` and `extreme`.

    stable, drifts, unstable: scheme, unstable: arithmetic, escapes, overflow at step k, underflow.
    Nothing of the scene is done but its [[stability]], [[largest_step]] and [[stability_map]].

    \b
    verify stability stiff
    verify stability --linear --scheme lie4
    """
    if linear:
        if scene is not None:
            raise InputError("SCENE", scene, "does not go with --linear")
        if scheme is None:
            raise InputError("--scheme", "", "is missing")
        return _linear(scheme)
    if scene is None:
        raise InputError("SCENE", "", "is missing; or give --linear --scheme NAME")
    if scheme is not None:
        raise InputError("--scheme", scheme, "goes with --linear; a scene names its own schemes")
    return _of_scenes(scene, keep, where)


def _of_scenes(scene: str, keep: Path | None, where: "Placement") -> Answer:
    from verify.execution.study import plan_of
    from verify.studies.stability.findings import findings_of
    from verify.studies.stability.plan import need_stability

    scenes = target(scene)[1]
    plan = plan_of(scenes, need_stability)
    if not plan.tasks:
        problem = "asks for no [[stability]], [[largest_step]] or [[stability_map]]"
        raise InputError("SCENE", scene, problem)
    found = findings_of(scenes, perform(plan, keep, where))
    return Answer(found.as_json, lambda: _print(found))


def _print(found: "StabilityFindings") -> None:
    width = max((len(run.verdict) for run in found.runs), default=0)
    for run in found.runs:
        click.echo(f"{run.verdict:{width}}  {run.id}")
        if run.kind not in _PLAIN:
            detail = textwrap.fill(run.detail, _WIDTH, initial_indent=_IN, subsequent_indent=_IN)
            click.echo(detail)
    for step in found.largest_steps:
        measured = f"bounded up to h = {step.bounded}" if step.bounded else "never bounded"
        linear = f"linear theory {step.linear}" if step.linear else "linear theory sets no limit"
        click.echo(f"{step.scheme}: {measured} until t = {step.time}; {linear}  {step.detail}")
    for over in found.maps:
        counted = ", ".join(f"{n} {kind}" for kind, n in over.counted().items())
        click.echo(f"{over.scheme}: {over.parameter} and step size: {counted}")


def _linear(scheme: str) -> Answer:
    from verify.algebra.formula import to_text
    from verify.studies.stability.linear import linear_stability

    found = linear_stability(scheme)
    data = {
        "scheme": found.scheme,
        "interval": found.decimal(),
        "interval_exact": found.exact,
        "delta_j": to_text(found.delta_j),
    }
    return Answer(lambda: data, lambda: _print_linear(found, data["delta_j"]))


def _print_linear(found: "LinearStability", delta_j: str) -> None:
    ends = {"infinite": "for every hω > 0", "0": "for no hω > 0"}
    shown = ends.get(found.exact, f"for 0 < hω < {found.decimal(12)}")
    click.echo(f"{found.scheme} on the harmonic oscillator is stable {shown}")
    if found.exact not in ends and not found.exact.isdecimal():
        click.echo(f"  exactly  {found.exact}")
    click.echo(f"  ΔJ       {delta_j}, y = hω")
