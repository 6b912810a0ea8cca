"""A report of integrators → one Markdown note for each mistake that is described and confirmed."""

import platform
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

from verify.files import write_atomically
from verify.integrators.others.findings.confirmed import Confirmed, NotConfirmedError, confirm
from verify.integrators.others.findings.described import descriptions
from verify.integrators.others.findings.markdown import note
from verify.scenes.results.report import Report


def write_findings(
    report: Report, folder: Path, on_finding: Callable[[str], None] = lambda _: None
) -> tuple[list[Path], dict[str, str]]:
    """The notes that were written, and by name why any was not. Raises what the disk raises."""
    folder.mkdir(exist_ok=True)
    written: list[Path] = []
    left: dict[str, str] = {}
    for name, described in descriptions().items():
        on_finding(name)
        try:
            found = confirm(name, described, report.claims)
        except NotConfirmedError as error:
            left[name] = str(error)
            continue
        path = folder / f"{name}.md"
        write_atomically(path, note(found, _judged(found, report)))
        written.append(path)
    return written, left


def _judged(found: Confirmed, report: Report) -> str:
    """What was judged, in which version, and by what."""
    versions = report.provenance.versions if report.provenance else {}
    library = found.described.library
    own = f"Judged here: {library} {versions[library]}, " if library in versions else "Judged "
    return f"{own}by areaproof {version('areaproof')}, Python {platform.python_version()}."
