"""A report of integrators → one Markdown note for each mistake that is described and confirmed."""

import platform
import re
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path

from jinja2 import StrictUndefined, Template

from verify.audits.findings.confirmed import Confirmed, NotConfirmedError, confirm, descriptions
from verify.files import write_atomically
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report

_CLAIMED, _HOLDS = re.compile(r"order (\d+)"), re.compile(r"order is (\d+)")
_OFF = re.compile(r"of h\^(\d+), .*? fails by (-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)")
_WEIGHTS = ", embedded weights"


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


def note(found: Confirmed, versions: str) -> str:
    """The text, which can be sent as it is.

    `versions`: of the library, as it is judged here, and of what judges it.
    """
    own = {"said": found.described, "orders": list(_orders(found.claims))}
    return _template().render(found=found, versions=versions, **own).rstrip() + "\n"


@cache
def _template() -> Template:
    text = (Path(__file__).parent / "note.jinja").read_text(encoding="utf-8")
    made: Template = Template(text, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    return made


def _orders(claims: Sequence[ClaimResult]) -> Iterator[tuple[str, ...]]:
    """Of each method the claimed order, the one that holds, and the first term that is off."""
    for claim in claims:
        claimed, holds = _CLAIMED.search(str(claim.statement)), _HOLDS.search(str(claim.evidence))
        off = _OFF.search(str(claim.evidence))
        if claimed and holds:
            term = f"h^{off[1]}" if off else "–"
            by = f"{abs(float(off[2])):.1e}" if off else "–"
            of = f"`{claim.source}`{_WEIGHTS if claim.kind.startswith('embedded') else ''}"
            yield of, claimed[1], holds[1], term, by
