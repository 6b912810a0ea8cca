"""`verify explore --maximise`: the worst scenes for a measure, as files and as a page."""

import re
import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared import output as show
from verify.commands.shared.destinations import check_ours, ensure_writable
from verify.commands.shared.execution_options import kept_tasks
from verify.commands.shared.output import CommandAnswer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.execution.execute import Store
    from verify.execution.executors import Placement
    from verify.exploration.hunting import Hunt
    from verify.exploration.sample_space import SampleSpace
    from verify.scenes.results.exploration import Gallery, GalleryScene, HuntResult

DEFAULT_STEPS = 100  # the steps of each hunted scene
_OUR_FILES = re.compile(r"worst-([0-9]+)\.toml|[A-Za-z0-9_-]+\.[0-9a-f]{8}\.toml")


def hunt(
    measure: str,
    seed: int,
    examples: int,
    steps: int,
    sample_space: "SampleSpace",
    output: Path,
    keep: Path | None,
    placement: "Placement",
) -> CommandAnswer:
    """Hunt for the worst scenes, write them and the page that shows them, and return the answer."""
    from verify.claims.verdicts import gallery_report
    from verify.exploration.hunting import Hunt, gallery, hunt
    from verify.pages.page import write

    request = Hunt(measure=measure, seed=seed, examples=examples, steps=steps, drawn=sample_space)
    # The folder is checked before hours of work, and must not hold somebody's files.
    check_ours(output, _OUR_FILES)
    ensure_writable(output)
    start_time, tasks = time.perf_counter(), request.plan.tasks
    with kept_tasks(tasks, keep) as (store, on_result):
        result = hunt(request, store, where=placement, done=on_result)
    if sample_space.degrees > 1:
        return _answer_in_degrees(request, result, store, output, placement)
    worst_gallery = gallery(request, result, store, where=placement)
    _write_scenes([scene.scene for scene in worst_gallery.scenes], output)
    report = gallery_report(
        worst_gallery, _format_command(request), start_time, store.taken, len(tasks), placement
    )
    page = write(report, output)
    summary = {"examples": worst_gallery.examples, "failures": [], "seed": seed}
    return CommandAnswer(
        lambda: summary | {"gallery": show.plain_json(worst_gallery)},
        lambda: _print(worst_gallery, output, page),
    )


def _answer_in_degrees(
    request: "Hunt", result: "HuntResult", store: "Store", output: Path, placement: "Placement"
) -> CommandAnswer:
    """Write the scenes and their report, and return the answer, in n degrees of freedom."""
    from verify.arithmetic.exact import text
    from verify.claims.verdicts import make_report
    from verify.exploration.island_search import scene_of
    from verify.exploration.measures import MEASURES
    from verify.pages.page import write
    from verify.scenes.scene import scene_text
    from verify.scenes.values import start_arguments

    sentence = MEASURES[request.measure].describe(request.drawn.degrees)
    scenes = [
        scene_of(sample).model_copy(
            # The value of a measure is a decimal logarithm.
            update={"name": f"worst-{rank}", "title": f"10^{sample.value:.2f}, {sentence}"}
        )
        for rank, sample in enumerate(result.worst, start=1)
    ]
    texts = list(map(scene_text, scenes))
    _write_scenes(texts, output)
    report = make_report(
        f"The worst scenes: {sentence}",
        scenes,
        [],
        store,
        command=_format_command(request),
        where=placement,
    )
    page = write(report, output)
    summary = {"examples": result.examples, "failures": [], "seed": request.seed}
    pairs = zip(result.worst, texts, strict=True)
    worst = [{"value": f"{sample.value}", "scene": toml} for sample, toml in pairs]
    details = {"measure": request.measure, "sentence": sentence, "worst": worst}

    def print_scenes() -> None:
        for rank, (sample, scene) in enumerate(zip(result.worst, scenes, strict=True), start=1):
            click.echo(f"{rank}. 10^{sample.value:.2f}  H = {scene.hamiltonian}")
            assert scene.grid is not None  # noqa: S101 - as drawn
            start, h = scene.grid.initial_values[0], scene.grid.step_sizes[0]
            coordinates = start_arguments(start, of_field=False).values()
            q, p = (", ".join(map(text, x)) for x in coordinates)
            click.echo(
                f"   {scene.schemes[0]}, h = {text(h)}, q = ({q}), p = ({p}); "
                f"{output / f'worst-{rank}.toml'}"
            )
        if not scenes:
            click.echo("no scene that was drawn can be measured so")
        click.echo(f"{result.examples:,} scenes of seed {request.seed}, by {sentence} → {page}")

    return CommandAnswer(lambda: summary | details, print_scenes)


def _format_command(request: "Hunt") -> str:
    """Return the command that repeats the hunt, without the options for its output."""
    options = [f"--maximise {request.measure} --examples {request.examples} --seed {request.seed}"]
    options += [f"--steps {request.steps}"] if request.steps != DEFAULT_STEPS else []
    options += [f"--scheme {shlex.quote(name)}" for name in request.drawn.schemes]
    options += [f"--kind {name}" for name in request.drawn.kinds]
    # An option with the default value is left out; the field says what the default is.
    if request.drawn.degree != type(request.drawn)().degree:
        options.append(f"--degree {request.drawn.degree}")
    if request.drawn.degrees > 1:
        options.append(f"--degrees {request.drawn.degrees}")
    if request.drawn.time_dependent:
        options.append("--time-dependent")
    return f"verify explore {' '.join(options)}"


def _write_scenes(texts: "Sequence[str]", output: Path) -> None:
    """Write worst-1.toml and so on, and delete those of an earlier hunt that had more."""
    from verify.files import write_atomically

    for rank, text in enumerate(texts, start=1):
        write_atomically(output / f"worst-{rank}.toml", text)
    for file in output.glob("worst-*.toml"):
        match = _OUR_FILES.fullmatch(file.name)
        if match and match[1] and int(match[1]) > len(texts):
            file.unlink()


def _print(gallery: "Gallery", output: Path, page: Path) -> None:
    for rank, scene in enumerate(gallery.scenes, start=1):
        separation = scene.separation
        click.echo(f"{rank}. 10^{scene.value:.2f}  H = {separation.hamiltonian}")
        start = f"h = {separation.step_size}, q = {separation.q}, p = {separation.p}"
        start += f", t0 = {separation.t0}" if separation.t0 != "0" else ""
        file = output / f"worst-{rank}.toml"
        click.echo(f"   {separation.scheme}, {start}: {_describe_loss(scene)}; {file}")
    if not gallery.scenes:
        click.echo("no scene that was drawn can be measured so")
    click.echo(
        f"{gallery.examples:,} scenes of seed {gallery.seed}, by {gallery.sentence} → {page}"
    )


def _describe_loss(scene: "GalleryScene") -> str:
    separation, last_meaningful = scene.separation, scene.meaningless_after
    longer = scene.longer
    longer_text = f", and over {longer.steps:,} steps it is {longer.status}" if longer else ""
    if separation.plain is None:
        return f"over {separation.steps:,} steps it is {separation.status}"
    if all(point.total == point.truncation == "0" for point in separation.plain.series):
        return (
            f"over {separation.steps:,} steps no digit of a part of Λ is known but 0{longer_text}"
        )
    if last_meaningful is None:
        return f"over {separation.steps:,} steps truncation is the larger part of Λ{longer_text}"
    until = f" until {scene.meaningful_from:,}" if scene.meaningful_from else ""
    return f"Λ of float64 is meaningless after {last_meaningful:,} steps{until}{longer_text}"
