"""A report of integrators → one Markdown note for each mistake that is described and confirmed."""

import platform
import re
from collections.abc import Callable, Iterator, Sequence
from importlib.metadata import version
from pathlib import Path

from verify.audits.findings.confirmed import (
    Confirmed,
    NotConfirmedError,
    Shown,
    confirm,
    descriptions,
)
from verify.audits.second.slopes import Slopes
from verify.files import write_atomically
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.report import Report

_CLAIMED, _HOLDS = re.compile(r"order (\d+)"), re.compile(r"order is (\d+)")
_OFF = re.compile(r"of h\^(\d+), .*? fails by (-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)")
_WEIGHTS = ", embedded weights"
_SHOWN = 4  # step sizes, the smallest
_FENCES = {"c++": "cpp"}


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
    said = found.described
    language = _FENCES.get(said.language, said.language)
    lines = [
        f"# {said.title}",
        "",
        f"**{said.library}**. {versions}",
        "",
        "## What is claimed",
        "",
        f"> {' '.join(said.quote.split())}",
        "",
        f"In {said.where}.",
        "",
        "## What holds",
        "",
        said.holds.strip(),
        "",
        *_orders(found.claims),
        "## A program that shows it",
        "",
        f"```{language}",
        said.program.strip("\n"),
        "```",
        "",
        *_printed(found),
        *_measured(found.tables),
        "## Where it is",
        "",
        said.blame.strip(),
        "",
        "## A mend",
        "",
        said.mend.strip(),
        "",
        *_with_mend(found),
    ]
    return "\n".join(lines).rstrip() + "\n"


def _orders(claims: Sequence[ClaimResult]) -> Iterator[str]:
    """Of each method the claimed order, the one that holds, and the first term that is off."""
    rows = []
    for claim in claims:
        claimed, holds = _CLAIMED.search(str(claim.statement)), _HOLDS.search(str(claim.evidence))
        off = _OFF.search(str(claim.evidence))
        if claimed and holds:
            term = f"h^{off[1]}" if off else "–"
            by = f"{abs(float(off[2])):.1e}" if off else "–"
            of = f"`{claim.source}`{_WEIGHTS if claim.kind.startswith('embedded') else ''}"
            rows.append(f"| {of} | {claimed[1]} | {holds[1]} | {term} | {by} |")
    if rows:
        yield "| method | claimed order | order that holds | first term that is off | by |"
        yield from ("|---|---|---|---|---|", *rows, "")


def _printed(found: Confirmed) -> Iterator[str]:
    said = found.described
    if found.program is not None:
        yield from ("It prints:", "", "```text", found.program.printed, "```", "")
        return
    if said.output:
        yield from (f"It prints ({said.ran}):", "", "```text", said.output.strip("\n"), "```", "")
    elif said.ran:
        yield from (f"It was {said.ran.removeprefix('it was ').rstrip('.')}.", "")


def _with_mend(found: Confirmed) -> Iterator[str]:
    if found.mended is not None and found.described.mended:
        yield from ("With it the program is:", "", "```python")
        yield from (found.described.mended.strip("\n"), "```", "", "and prints:", "", "```text")
        yield from (found.mended.printed, "```", "")
    for table in found.tables:
        if table.mended:
            orders = sorted({x.order for x in table.mended if x.order is not None})
            told = " and ".join(f"order {x}" for x in orders)
            yield f"With it `{_last(table)}` shows {told}, for both systems of the table above."


def _last(table: Shown) -> str:
    return table.name.partition("/")[2]


def _measured(tables: Sequence[Shown]) -> Iterator[str]:
    """One step of each table at 60 digits, against the solution."""
    if not tables:
        return
    yield from ("## Measured", "")
    yield "The error of one step of size h, carried out with 60 digits as the library does it:"
    yield ""
    lines = list[str]()
    for table in tables:
        for k, slopes in enumerate(table.printed):
            lines.append(_row(f"`{_last(table)}`", slopes, slopes.said))
            if table.mended:
                lines.append(_row(f"`{_last(table)}`, mended", table.mended[k], slopes.said))
    head = "| table | system | h = 1/16 | 1/32 | 1/64 | 1/128 | order |"
    yield from (head, "|---|---|---|---|---|---|---|", *lines, "")


def _row(name: str, slopes: Slopes, said: str) -> str:
    errors = " | ".join(f"{error:.1e}" for _, error in slopes.rows[-_SHOWN:])
    order = "–" if slopes.order is None else str(slopes.order)
    return f"| {name} | {said} | {errors} | {order} |"
