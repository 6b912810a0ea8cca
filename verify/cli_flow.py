"""The command `verify flow`: regions carried by maps, and their areas."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify import show
from verify.cli_input import target, writable
from verify.cli_tasks import told, with_tasks
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.flow_results import FlowImage, FlowResult

NO_RESULT = 1  # exit status


@click.command()
@click.argument("scene", metavar="SCENE")
@with_tasks
def flow(scene: str, keep: Path | None, workers: int | None, as_json: bool) -> None:
    """Carry the regions of SCENE by its maps, and measure what these do to their areas.

    SCENE is a TOML file with [[flow]] sections, or `paper`; nothing else of it is done. Exit status
    1 where a map's area could not be measured far more finely than it changes.

    \b
    [[flow]]
    shape = "cat"                     # circle, square; polygon = [[0, 0], …]; path = "M 0 0 …"
    centre = { q = 1, p = 0 }
    scale = 0.5
    step_size = 0.01
    steps = [5000, 20000]             # or times = [1, 2, 3]
    """
    from verify.execute import Store, execute
    from verify.flow_findings import flow_json, flows_of
    from verify.flow_plan import plan_flows

    scenes = target(scene)[1]
    plan = plan_flows(scenes)
    if not plan.tasks:
        raise InputError("SCENE", scene, "asks for no [[flow]]")
    if keep is not None:
        writable(keep)
    with told(plan.tasks, keep) as done:
        results = execute(plan, Store(keep), workers=workers, done=done)
    found = [(each.name, flow) for each in scenes for flow in flows_of(each, results)]
    if as_json:
        show.print_json(flow_json(found))
    else:
        for name, result in found:
            _print(name, result)
    if any(image.problem for _, flow in found for image in flow.images):
        raise SystemExit(NO_RESULT)


def _print(name: str, result: "FlowResult") -> None:
    q, p = result.centre
    title = f"{name}: " + (f"{result.source}, " if result.source else "")
    where = f"{result.shape} at (q, p) = ({q}, {p}), scale {result.scale}"
    click.echo(f"{title}{where}, h = {result.step_size}")
    for image in result.images:
        click.echo(f"  {image.map}, N = {image.steps}, t = {image.time}: {_told(image)}")


def _told(image: "FlowImage") -> str:
    if image.problem:
        return image.problem
    parts = [f"area changes by {image.area_change} ± {image.probe_error}"]
    if image.area_preserving:
        parts = [f"area unchanged by proof; measured {image.area_change} ± {image.probe_error}"]
    if image.mean_lambda is not None:
        same = "the same" if image.agree else "NOT the same"
        parts.append(f"mean Λ {image.mean_lambda} ± {image.mean_lambda_error}, {same}")
    if image.distance is not None:
        parts.append(f"{image.distance} ± {image.distance_error} from the exact flow")
    return "; ".join(parts)
