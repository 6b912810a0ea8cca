"""`verify explore --maximise`: the worst scenes for a measure, as files and as a page."""

import re
import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared import output as show
from verify.commands.shared.answer import Answer
from verify.commands.shared.destinations import check_ours, writable
from verify.commands.shared.tasks import kept_tasks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.execution.execute import Store
    from verify.execution.executors import Placement
    from verify.exploration.hunting import Hunt
    from verify.exploration.sample_space import SampleSpace
    from verify.scenes.results.exploration import Gallery, GalleryScene, HuntResult

STEPS = 100  # of each scene, where nothing else is asked for
_OWN = re.compile(r"worst-([0-9]+)\.toml|[A-Za-z0-9_-]+\.[0-9a-f]{8}\.toml")


def hunt(
    measure: str,
    seed: int,
    examples: int,
    steps: int,
    drawn: "SampleSpace",
    output: Path,
    keep: Path | None,
    where: "Placement",
) -> Answer:
    """Hunts, writes the worst scenes and the page that shows them, and answers what was found."""
    from verify.claims.report import gallery_report
    from verify.exploration.gallery import gallery
    from verify.exploration.hunting import Hunt, hunt
    from verify.pages.page import write

    asked = Hunt(measure=measure, seed=seed, examples=examples, steps=steps, drawn=drawn)
    check_ours(output, _OWN)
    writable(output)
    begun, tasks = time.perf_counter(), asked.plan.tasks
    with kept_tasks(tasks, keep) as (store, done):
        found = hunt(asked, store, where=where, done=done)
    if drawn.degrees > 1:
        return _in_degrees(asked, found, store, output, where)
    shown = gallery(asked, found, store, where=where)
    _write_scenes([each.scene for each in shown.scenes], output)
    report = gallery_report(shown, _command(asked), begun, store.taken, len(tasks), where)
    page = write(report, output)
    told = {"examples": shown.examples, "failures": [], "seed": seed}
    return Answer(
        lambda: told | {"gallery": show.plain_json(shown)}, lambda: _print(shown, output, page)
    )


def _in_degrees(
    asked: "Hunt", found: "HuntResult", store: "Store", output: Path, where: "Placement"
) -> Answer:
    """The worst scenes in n degrees of freedom: the page is their report."""
    from verify.arithmetic.exact import text
    from verify.claims.report import make_report
    from verify.exploration.different_scenes import scene_of
    from verify.exploration.measures import MEASURES
    from verify.pages.page import write
    from verify.scenes.toml_text import scene_text

    said = MEASURES[asked.measure].said(asked.drawn.degrees)
    scenes = [
        scene_of(each).model_copy(
            update={"name": f"worst-{place}", "title": f"10^{each.value:.2f}, {said}"}
        )
        for place, each in enumerate(found.worst, start=1)
    ]
    texts = list(map(scene_text, scenes))
    _write_scenes(texts, output)
    report = make_report(
        f"The worst scenes: {said}", scenes, [], store, command=_command(asked), where=where
    )
    page = write(report, output)
    told = {"examples": found.examples, "failures": [], "seed": asked.seed}
    pairs = zip(found.worst, texts, strict=True)
    worst = [{"value": f"{each.value}", "scene": toml} for each, toml in pairs]
    shown = {"measure": asked.measure, "sentence": said, "worst": worst}

    def tell() -> None:
        for place, (each, scene) in enumerate(zip(found.worst, scenes, strict=True), start=1):
            click.echo(f"{place}. 10^{each.value:.2f}  H = {scene.hamiltonian}")
            assert scene.grid is not None  # noqa: S101 - as drawn
            start, h = scene.grid.initial_values[0], scene.grid.step_sizes[0]
            q, p = (", ".join(map(text, x)) for x in (start.q, start.p) if isinstance(x, tuple))
            click.echo(
                f"   {scene.schemes[0]}, h = {text(h)}, q = ({q}), p = ({p}); "
                f"{output / f'worst-{place}.toml'}"
            )
        if not scenes:
            click.echo("no scene that was drawn can be measured so")
        click.echo(f"{found.examples:,} scenes of seed {asked.seed}, by {said} → {page}")

    return Answer(lambda: told | shown, tell)


def _command(asked: "Hunt") -> str:
    """What makes the same hunt again."""
    own = [f"--maximise {asked.measure} --examples {asked.examples} --seed {asked.seed}"]
    own += [f"--steps {asked.steps}"] if asked.steps != STEPS else []
    own += [f"--scheme {shlex.quote(name)}" for name in asked.drawn.schemes]
    own += [f"--kind {name}" for name in asked.drawn.kinds]
    if asked.drawn.degree != type(asked.drawn)().degree:
        own.append(f"--degree {asked.drawn.degree}")
    if asked.drawn.degrees > 1:
        own.append(f"--degrees {asked.drawn.degrees}")
    if asked.drawn.time_dependent:
        own.append("--time-dependent")
    return f"verify explore {' '.join(own)}"


def _write_scenes(texts: "Sequence[str]", output: Path) -> None:
    """Writes worst-1.toml and so on; those of an earlier hunt that had more do not stay."""
    from verify.files import write_atomically

    for place, text in enumerate(texts, start=1):
        write_atomically(output / f"worst-{place}.toml", text)
    for file in output.glob("worst-*.toml"):
        own = _OWN.fullmatch(file.name)
        if own and own[1] and int(own[1]) > len(texts):
            file.unlink()


def _print(shown: "Gallery", output: Path, page: Path) -> None:
    for place, each in enumerate(shown.scenes, start=1):
        of = each.separation
        click.echo(f"{place}. 10^{each.value:.2f}  H = {of.hamiltonian}")
        start = f"h = {of.step_size}, q = {of.q}, p = {of.p}"
        start += f", t0 = {of.t0}" if of.t0 != "0" else ""
        click.echo(f"   {of.scheme}, {start}: {_when(each)}; {output / f'worst-{place}.toml'}")
    if not shown.scenes:
        click.echo("no scene that was drawn can be measured so")
    click.echo(f"{shown.examples:,} scenes of seed {shown.seed}, by {shown.sentence} → {page}")


def _when(each: "GalleryScene") -> str:
    of, after = each.separation, each.meaningless_after
    longer = each.longer
    beyond = f", and over {longer.steps:,} steps it is {longer.status}" if longer else ""
    if of.plain is None:
        return f"over {of.steps:,} steps it is {of.status}"
    if all(at.total == at.truncation == "0" for at in of.plain.series):
        return f"over {of.steps:,} steps no digit of a part of Λ is known but 0{beyond}"
    if after is None:
        return f"over {of.steps:,} steps truncation is the larger part of Λ{beyond}"
    until = f" until {each.meaningful_from:,}" if each.meaningful_from else ""
    return f"Λ of float64 is meaningless after {after:,} steps{until}{beyond}"
