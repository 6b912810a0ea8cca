"""The command `verify report`: a page, and the same results as JSON beside it."""

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import destinations
from verify.commands.shared import output as show
from verify.commands.shared.execution_options import kept_tasks, with_placement
from verify.commands.shared.input import hamiltonian_of, load_target
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, answering
from verify.commands.shared.scene_options import (
    check_scene_alone,
    line_of,
    scenes_of,
    start_options,
    with_one_line,
)
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.claims.claims_file import ClaimsFile
    from verify.execution.executors import Placement
    from verify.scenes.results.report import Report
    from verify.scenes.scene import Scene

_INTEGRATORS = "integrators"
_MOST = 8  # processes, unless more are asked for
_PAGE = "html"


@click.command()
@with_one_line(
    option("--steps", "N", "At least 1; or:", type=int),
    option("--time", "T", "N is T/H rounded down."),
)
@start_options
@option("-o --output", "DIR", "Write it.  [default: SCENE-report]", type=destinations.OUT_FOLDER)
@click.option(
    "--format",
    "formats",
    type=click.Choice(["html", "md"]),
    multiple=True,
    default=["html"],
    help="html, DIR/index.html, or md, DIR/report.md with DIR/figures, for a "
    "repository; repeatable.",
)
@flag("--full", "Unfold all that the page folds, on paper too: many pages.")
@option(
    "--findings",
    "DIR",
    "Of integrators: a note for its maintainers on each mistake that matters, DIR/NAME.md.",
    type=destinations.OUT_FOLDER,
)
@option(
    "--errata",
    "DIR",
    "Of a paper: an erratum to copy, DIR/errata.tex and .md, and a page for an editor.",
    type=destinations.OUT_FOLDER,
)
@flag("--force", "Also into a folder with files that are not ours.")
@with_placement
@answering
def report(
    scene: str | None,
    output: Path | None,
    formats: tuple[str, ...],
    full: bool,
    findings: Path | None,
    errata: Path | None,
    force: bool,
    placement: "Placement",
    **options: Any,
) -> CommandAnswer:
    """Verify SCENE and write DIR/index.html and DIR/results.json.

    SCENE is a TOML file of a scene or of claims, `paper`, `stiff`, `extreme`, `several-degrees` or
    `integrators`; or a scheme of one's own and where it starts, in one line:

    \b
    verify report --system duffing --param delta=1 --scheme lie2 --step-size 0.01 --time 100 \\
           --q 1 --p 0 -o mine

    What is finished is kept in DIR/kept; an interrupted report goes on from there. The exit status
    is 1 where a structure that a scene says is kept, by its `keeps`, is refuted.

    `integrators` holds what other libraries claim of their integrators, order, symplecticity and
    clocks, against what is found: those of the extras peers and heavy-peers that are installed, and
    coefficient tables as libraries and papers print them. It runs their code.
    """
    typed_options = "" if formats == ("html",) else "".join(f" --format {name}" for name in formats)
    if full:
        if _PAGE not in formats:
            raise InputError("--full", ", ".join(formats), "is of --format html, which folds")
        typed_options += " --full"
    if findings is not None and scene != _INTEGRATORS:
        raise InputError("--findings", str(findings), "is of `verify report integrators`")
    refutes_keeps = False
    if scene == _INTEGRATORS:
        _check_errata(errata, None)
        folder, result = _verify_integrators(scene, output, typed_options, placement, force)
    else:
        request = _read_request(scene, options)
        _check_errata(errata, request.claims)
        folder, result = _verify_scene(request, output, typed_options, placement, force)
        refutes_keeps = _refutes_keeps(request.scenes, result)
    # Each format once, in the order in which they were typed.
    paths = [_select_writer(name, full)(result, folder) for name in dict.fromkeys(formats)]
    if findings is not None:
        paths += _write_notes(result, findings)
    if errata is not None:
        from verify.pages.errata.errata import write_errata

        paths += write_errata(result, errata)
    return CommandAnswer(
        lambda: result.model_dump(mode="json"),
        lambda: show.print_report(result, *paths),
        failed=refutes_keeps,
    )


@dataclass(frozen=True)
class _Request:
    """The scenes and claims to verify; `arguments`: as typed; `name`: that of the folder."""

    arguments: str
    name: str
    title: str
    scenes: "list[Scene]"
    claims: "ClaimsFile | None" = None


def _check_errata(folder: Path | None, claims: "ClaimsFile | None") -> None:
    """Raise InputError, before anything is computed, if there can be no erratum."""
    if folder is None:
        return
    if claims is None or not any(claim.reading_of for claim in claims.claims):
        raise InputError("--errata", str(folder), "is of claims that are readings of statements")
    destinations.ensure_writable(folder, "--errata")


def _read_request(scene: str | None, options: Mapping[str, Any]) -> _Request:
    if scene is None:
        scenes = scenes_of(None, options, ("q", "p"), partial(_build_sections, options))
        name = options["system"] or "hamiltonian"
        return _Request(
            line_of(options), name, f"{', '.join(options['schemes'])} on {name}", scenes
        )
    check_scene_alone(options)
    title, scenes, file = load_target(scene, _INTEGRATORS)
    # A file of claims is one paper, however many scenes it has.
    name = scenes[0].name if file is None and len(scenes) == 1 else Path(scene).stem
    return _Request(scene, name, title, scenes, file)


def _build_sections(
    options: Mapping[str, Any], *, q: Any, p: Any, step_sizes: Sequence[str], **length: Any
) -> dict[str, Any]:
    """Return the sections of a report on one orbit: proofs, runs at each step, series over time."""
    from verify.arithmetic.exact import positive
    from verify.scenes.observables import carries_defect

    hamiltonian = hamiltonian_of(options["system"], options["hamiltonian"], options["params"])
    start = {"q": q, "p": p}
    grid: dict[str, Any] = {"step_sizes": step_sizes, "initial_values": [start]}
    grid |= {"separate": True} if carries_defect(hamiltonian) else {}
    plane = hamiltonian.planar  # which alone has the criteria and a law of growth
    grid |= {"growth": True} if plane and not hamiltonian.time_dependent else {}
    largest = max(positive(h, "step_size") for h in step_sizes)
    return {
        **({"criteria": [1, 2, 3, 4], "every_hamiltonian": True} if plane else {}),
        "grid": {**grid, **length},
        "series": [{"step_size": largest, "initial_value": start, **length}],
    }


def _verify_scene(
    request: _Request, output: Path | None, typed_options: str, placement: "Placement", force: bool
) -> "tuple[Path, Report]":
    from verify.claims.verdicts import add_claims, make_report
    from verify.studies.tasks_of_scenes import plan_scenes

    file, scenes = request.claims, request.scenes
    claims, claim_scenes = (file.claims, file.scenes) if file else ([], {})
    folder = output or Path(f"{request.name}-report")
    _check_folder(folder, force)
    destinations.ensure_keepable(folder, "--output")
    planned = plan_scenes(scenes)
    add_claims(planned, claims, {scene.name: scene for scene in scenes} | claim_scenes)
    with kept_tasks(planned.tasks, folder / "kept", "--output") as (store, on_result):
        result = make_report(
            request.title,
            scenes,
            claims,
            store,
            command=f"verify report {request.arguments} -o {folder.name}{typed_options}",
            claim_scenes=claim_scenes,
            causes=file.causes if file else (),
            assumptions=file.assumptions if file else (),
            figures=file.figures if file else (),
            preface=file.about if file else (),
            not_claimed=file.left_out if file else (),
            plan=planned,
            where=placement,
            done=on_result,
        )
    return folder, result


def _refutes_keeps(scenes: "Sequence[Scene]", report: "Report") -> bool:
    """Return True if a structure is refuted that a scene says is kept, not one only looked at."""
    claiming = (x for scene, x in zip(scenes, report.scenes, strict=True) if scene.keeps)
    return any(kept.verdict == "REFUTED" for scene in claiming for kept in scene.keeps)


def _verify_integrators(
    scene: str, output: Path | None, typed_options: str, placement: "Placement", force: bool
) -> "tuple[Path, Report]":
    """Audit other libraries on this machine, one a process."""
    from verify.audits.integrators_report import make_integrators_report

    if placement.cluster is not None:
        raise InputError("--cluster", placement.cluster, "the integrators of others are run here")
    folder = output or Path(f"{scene}-report")
    _check_folder(folder, force)
    destinations.ensure_writable(folder)
    command = f"verify report {scene} -o {folder.name}{typed_options}"
    workers = placement.workers or min(_MOST, os.cpu_count() or 1)
    return folder, make_integrators_report(command, _show_progress, workers)


def _write_notes(result: "Report", folder: Path) -> list[Path]:
    """Write the notes, and return their paths; standard error says why one was not written."""
    from verify.audits.mistake_note import write_findings

    destinations.ensure_writable(folder)
    paths, unwritten = write_findings(result, folder, _show_progress)
    for name, reason in unwritten.items():
        click.echo(f"{name}.md is not written: {reason}", err=True)
    return paths


def _check_folder(folder: Path, force: bool) -> None:
    if not force:
        destinations.check_ours(folder, advice=", or --force")


def _show_progress(name: str) -> None:
    """Print the progress, on a terminal only."""
    if sys.stderr.isatty():
        click.echo(f"{name} …", err=True)


def _select_writer(name: str, full: bool) -> "Callable[[Report, Path], Path]":
    """Return the writer of a report in that format, importing no other."""
    if name == _PAGE:
        from verify.pages.page import write as write_page

        return lambda result, folder: write_page(result, folder, full=full)
    from verify.pages.markdown.page import write

    return write
