"""The command `verify report`: a page, and the same results as JSON beside it."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared import output as show
from verify.commands.shared.answer import Answer, answering
from verify.commands.shared.input import PATH, check_ours, keepable, target, writable
from verify.commands.shared.tasks import kept_tasks, with_placement
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.scenes.results.report import Report

_INTEGRATORS = "integrators"


@click.command()
@click.argument("scene", metavar="SCENE")
@click.option(
    "-o", "--output", type=PATH, metavar="DIR", help="Write it there.  [default: SCENE-report]"
)
@click.option(
    "--format",
    "formats",
    type=click.Choice(["html", "md"]),
    multiple=True,
    default=["html"],
    help="html, DIR/index.html, or md, DIR/report.md with DIR/figures, for a "
    "repository; repeatable.",
)
@click.option("--force", is_flag=True, help="Also into a folder with files that are not ours.")
@with_placement
@answering
def report(
    scene: str,
    output: Path | None,
    formats: tuple[str, ...],
    force: bool,
    where: "Placement",
) -> Answer:
    """Verify SCENE and write DIR/index.html and DIR/results.json.

    SCENE is a TOML file, `paper`, `stiff`, `extreme` or `integrators`.

    What is finished is kept in DIR/kept; an interrupted report goes on from there.

    `integrators` holds what other libraries claim of their integrators, order and symplecticity,
    against what is found: scipy, heyoka, galpy, rebound and nodepy, where they are installed, and
    coefficient tables of splitting methods as they are printed. It runs their code.
    """
    asked = "" if formats == ("html",) else "".join(f" --format {name}" for name in formats)
    folder, made = (_integrators if scene == _INTEGRATORS else _scene)(
        scene, output, asked, where, force
    )
    written = [_writer(name)(made, folder) for name in dict.fromkeys(formats)]
    return Answer(lambda: made.model_dump(mode="json"), lambda: show.print_report(made, *written))


def _scene(
    scene: str, output: Path | None, asked: str, where: "Placement", force: bool
) -> "tuple[Path, Report]":
    from verify.claims.plan import add_claims
    from verify.claims.report import make_report
    from verify.studies.plan import plan_scenes

    title, scenes, file = target(scene)
    claims, claim_scenes = (file.claims, file.scenes) if file else ([], {})
    folder = output or Path(f"{scenes[0].name if len(scenes) == 1 else scene}-report")
    _check(folder, force)
    keepable(folder, "--output")
    planned = plan_scenes(scenes)
    add_claims(planned, claims, {scene.name: scene for scene in scenes} | claim_scenes)
    with kept_tasks(planned.tasks, folder / "kept", "--output") as (store, done):
        made = make_report(
            title,
            scenes,
            claims,
            store,
            command=f"verify report {scene} -o {folder.name}{asked}",
            claim_scenes=claim_scenes,
            figures=file.figures if file else (),
            preface=file.about if file else (),
            not_claimed=file.left_out if file else (),
            plan=planned,
            where=where,
            done=done,
        )
    return folder, made


def _integrators(
    scene: str, output: Path | None, asked: str, where: "Placement", force: bool
) -> "tuple[Path, Report]":
    """Other libraries run here, in this process: they are not sent to workers."""
    from verify.integrators.others.report import make_integrators_report

    if where.cluster is not None:
        raise InputError("--cluster", where.cluster, "the integrators of others are run here")
    folder = output or Path(f"{scene}-report")
    _check(folder, force)
    writable(folder)
    command = f"verify report {scene} -o {folder.name}{asked}"
    return folder, make_integrators_report(command, _tell)


def _check(folder: Path, force: bool) -> None:
    if not force:
        check_ours(folder, advice=", or --force")


def _tell(name: str) -> None:
    """Progress, on a terminal only."""
    if sys.stderr.isatty():
        click.echo(f"{name} …", err=True)


def _writer(name: str) -> "Callable[[Report, Path], Path]":
    """What writes a report in that format; only what is asked for is imported."""
    if name == "md":
        from verify.pages.markdown.page import write
    else:
        from verify.pages.page import write
    return write
