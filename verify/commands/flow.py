"""The command `verify flow`: regions carried by maps, and their areas."""

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.arithmetic.exact import short
from verify.commands.shared.execution_options import perform, with_tasks
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, print_once
from verify.commands.shared.scene_options import scenes_of, with_one_line
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.scenes.results.regions import FlowImage, FlowResult


@click.command()
@with_one_line(
    option("--steps", "N", "At least 1; repeatable; or give --time.", type=int, multiple=True),
    option("--time times", "T", "N is T/H rounded down; repeatable.", multiple=True),
    option("--shape", "NAME", "circle, square or cat.  [default: circle]"),
    option(
        "--q",
        "Q",
        "The displacement of the shape's centre; for q1, q2, … as 0.1,0.2.  [default: 0]",
    ),
    option("--p", "P", "The momentum of the centre, as --q.  [default: 0]"),
    option(
        "--plane",
        "I",
        "In n degrees of freedom the shape lies in (qI, pI).  [default: 1]",
        type=int,
    ),
    option("--scale", "S", "The factor of the shape's size.  [default: 1]"),
)
@with_tasks
def flow(
    scene: str | None, keep: Path | None, placement: "Placement", **options: Any
) -> CommandAnswer:
    """Carry the regions of SCENE by its maps, and measure what these do to their areas.

    SCENE is a TOML file with [[flow]] sections, or `paper`; its other sections are ignored. Exit
    status 1 if a map has no image of a region, or the area of an image cannot be measured far more
    finely than it changes.

    \b
    verify flow --system pendulum --scheme lie2 --shape cat --q 1 --step-size 0.1 --time 1 --time 5

    \b
    [[flow]]
    shape = "cat"                     # circle, square; polygon = [[0, 0], …]; path = "M 0 0 …"
    centre = { q = 1, p = 0 }
    scale = 0.5
    step_size = 0.01
    steps = [5000, 20000]             # or times = [1, 2, 3]
    """
    from verify.execution.plan import plan_of
    from verify.scenes.values import describe_rounding
    from verify.studies.kinds.regions import flow_json, flows_of, need_flows

    scenes = scenes_of(scene, options, (), _build_sections)
    plan = plan_of(scenes, need_flows)
    if not plan.tasks:
        raise InputError("SCENE", scene or NOT_GIVEN, "asks for no [[flow]]; add one")
    results = perform(plan, keep, placement)
    flows = [
        (region_scene.name, flow)
        for region_scene in scenes
        for flow in flows_of(region_scene, results)
    ]
    sections = [section for region_scene in scenes for section in region_scene.flow]
    notes = [
        describe_rounding(t, [section.step_size]) for section in sections for t in section.times
    ]

    def show() -> None:
        for name, result in flows:
            _print_flow(name, result)
        print_once(notes)

    return CommandAnswer(
        lambda: flow_json(flows),
        show,
        failed=any(image.problem for _, flow in flows for image in flow.images),
    )


def _build_sections(
    *,
    step_sizes: Sequence[str],
    q: "str | list[str] | None" = None,
    p: "str | list[str] | None" = None,
    shape: str = "circle",
    **section_keys: Any,
) -> dict[str, Any]:
    """Return one [[flow]] section for each step size."""
    if q or p:  # if one of them is left out, it is as many zeros as the other has numbers
        section_keys["centre"] = {"q": q or _zeros_like(p), "p": p or _zeros_like(q)}
    section_keys["shape"] = shape
    return {"flow": [{"step_size": h, **section_keys} for h in step_sizes]}


def _zeros_like(coordinates: "str | list[str] | None") -> str | list[str]:
    return ["0"] * len(coordinates) if isinstance(coordinates, list) else "0"


def _print_flow(name: str, result: "FlowResult") -> None:
    q, p = result.centre
    title = f"{name}: " + (f"{result.source}, " if result.source else "")
    i = result.plane or ""  # the index of the plane (q_i, p_i), in n degrees of freedom
    region_text = (
        f"{result.shape} at (q{i}, p{i}) = ({q}, {p}), scale {short(Fraction(result.scale))}"
    )
    region_text += "".join(f", {n} = {x}" for n, x in result.point.items() if n[1:] != str(i))
    start_note = "" if result.t0 is None else f", from t0 = {result.t0}"
    click.echo(f"{title}{region_text}, h = {result.step_size}{start_note}")
    rows = [_HEAD_IN_DEGREES if i else _HEAD, *map(_format_row, result.images)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row, image in zip(rows, (None, *result.images), strict=True):
        line = "  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True))
        click.echo(f"  {line.rstrip()}")
        if image is not None and image.problem:
            click.echo(f"    {image.problem}")


_HEAD = ("map", "N", "t", "area changes by", "mean of Λ", "from the exact flow")
_HEAD_IN_DEGREES = ("map", "N", "t", "∮ p·dq changes by", "mean of W", "of it in each plane")


def _format_row(image: "FlowImage") -> tuple[str, ...]:
    change = _format_with_error(image.area_change, image.probe_error)
    if image.area_preserving and change:
        change = f"0, proved ({change})"
    mean = _format_with_error(image.mean_lambda, image.mean_lambda_error)
    mean = mean or _format_with_error(image.mean_defect, image.mean_defect_error)
    # The change of ∮ p·dq equals the mean of W over the region: one number, computed twice.
    mean += "" if image.agree is not False else "  NOT THE SAME"
    distance = _format_with_error(image.distance, image.distance_error)
    planes = image.outlines[0].projections if image.outlines else ()
    shares = " ".join(f"{float(x.area):.5g}" for x in planes)
    return image.map, str(image.steps), image.time, change, mean, shares or distance


def _format_with_error(value: str | None, error: str | None) -> str:
    return "" if value is None else f"{value} ± {error}"
