"""`verify explore --maximise`: the worst scenes for a measure, as files and as a page."""

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify import show
from verify.cli_input import writable
from verify.cli_tasks import told

if TYPE_CHECKING:
    from verify.executors import Where
    from verify.explore_results import Gallery
    from verify.results import SeparationResult
    from verify.tasks import Drawn


def hunt(
    measure: str,
    seed: int,
    examples: int,
    steps: int,
    drawn: "Drawn",
    output: Path,
    keep: Path | None,
    where: "Where",
    as_json: bool,
) -> None:
    """Hunts, writes the worst scenes and the page that shows them, and tells what was found."""
    from reports.page import write
    from verify.execute import Store
    from verify.gallery import gallery
    from verify.hunting import Hunt, hunt
    from verify.keeping import write_atomically
    from verify.report import gallery_report

    asked = Hunt(measure=measure, seed=seed, examples=examples, steps=steps, drawn=drawn)
    writable(output)
    if keep is not None:
        writable(keep)
    store, begun = Store(keep), time.perf_counter()
    with told(asked.plan().tasks, keep) as done:
        worst = hunt(asked, store, where=where, done=done)
    shown = gallery(asked, worst, store, where=where)
    for place, each in enumerate(shown.scenes, start=1):
        write_atomically(output / f"worst-{place}.toml", each.scene)
    command = f"verify explore --maximise {measure} --examples {examples} --seed {seed}"
    page = write(gallery_report(shown, command, begun, len(asked.plan().tasks), where), output)
    if as_json:
        show.print_json({"examples": examples, "failures": [], "seed": seed}
                        | {"gallery": shown.model_dump(mode="json")})  # fmt: skip
    else:
        _print(shown, output, page)


def _print(shown: "Gallery", output: Path, page: Path) -> None:
    for place, each in enumerate(shown.scenes, start=1):
        of = each.separation
        click.echo(f"{place}. 10^{each.value:.2f}  H = {of.hamiltonian}")
        start = f"h = {of.step_size}, q = {of.q}, p = {of.p}"
        when = _when(each.meaningless_after, of)
        click.echo(f"   {of.scheme}, {start}: {when}; {output / f'worst-{place}.toml'}")
    click.echo(f"{shown.examples:,} scenes of seed {shown.seed}, by {shown.sentence} → {page}")


def _when(after: int | None, of: "SeparationResult") -> str:
    if of.status != "finished":
        return f"over {of.steps:,} steps it is {of.status}"
    if after is None:
        return f"Λ of float64 keeps a digit over {of.steps:,} steps"
    return f"Λ of float64 is meaningless after {after:,} steps"
