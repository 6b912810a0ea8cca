"""Markdown notes on a report of integrators, one for each described and confirmed mistake."""

import platform
import re
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path

from jinja2 import StrictUndefined, Template

from verify.audits import mistake
from verify.files import write_atomically
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report

_CLAIMED_ORDER, _ORDER_THAT_HOLDS = re.compile(r"order (\d+)"), re.compile(r"order is (\d+)")
_FIRST_WRONG_TERM = re.compile(r"of h\^(\d+), .*? fails by (-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)")
_WEIGHTS = ", embedded weights"


def write_findings(
    report: Report, folder: Path, on_finding: Callable[[str], None] = lambda _: None
) -> tuple[list[Path], dict[str, str]]:
    """Write the notes; return their paths, and by name the reason why a note was not written.

    Raises OSError.
    """
    folder.mkdir(exist_ok=True)
    paths: list[Path] = []
    reasons: dict[str, str] = {}
    for name, described in mistake.descriptions().items():
        on_finding(name)
        try:
            confirmed = mistake.confirm(name, described, report.claims)
        except mistake.NotConfirmedError as error:
            reasons[name] = str(error)
            continue
        path = folder / f"{name}.md"
        write_atomically(path, note(confirmed, _describe_versions(confirmed, report)))
        paths.append(path)
    return paths, reasons


def _describe_versions(confirmed: mistake.ConfirmedFinding, report: Report) -> str:
    """Describe the version that was judged, and the versions of areaproof and Python."""
    versions = report.provenance.versions if report.provenance else {}
    library = confirmed.described.library
    opening = f"Judged here: {library} {versions[library]}, " if library in versions else "Judged "
    return f"{opening}by areaproof {version('areaproof')}, Python {platform.python_version()}."


def note(confirmed: mistake.ConfirmedFinding, versions: str) -> str:
    """Return the text of the note, which can be sent as it is.

    `versions`: a sentence on the versions of the library, of areaproof and of Python.
    """
    context = {"said": confirmed.described, "orders": list(_orders(confirmed.claims))}
    return _template().render(confirmed=confirmed, versions=versions, **context).rstrip() + "\n"


@cache
def _template() -> Template:
    text = (Path(__file__).parent / "note.jinja").read_text(encoding="utf-8")
    template: Template = Template(
        text, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return template


def _orders(claims: Sequence[ClaimResult]) -> Iterator[tuple[str, ...]]:
    """Yield a row for each method: its label, the claimed order, the order that holds, the first
    wrong power of h, and the size of its error."""
    for claim in claims:
        claimed = _CLAIMED_ORDER.search(str(claim.statement))
        holds = _ORDER_THAT_HOLDS.search(str(claim.evidence))
        gap = _FIRST_WRONG_TERM.search(str(claim.evidence))
        if claimed and holds:
            term = f"h^{gap[1]}" if gap else "–"
            by = f"{abs(float(gap[2])):.1e}" if gap else "–"
            label = f"`{claim.source}`{_WEIGHTS if claim.kind.startswith('embedded') else ''}"
            yield label, claimed[1], holds[1], term, by
