"""Tables that libraries have in their sources: a TOML file for each in `reports/audits`.

The files are those that `verify check-table` takes; `title` is the library with its version. What
is found is told as of any other integrator of others.
"""

from collections.abc import Iterator
from pathlib import Path

from verify.content import content
from verify.integrators.others.reproductions import of_clock
from verify.integrators.tables.check import Judgement, TableFile
from verify.integrators.tables.entry import TableEntry
from verify.prose import prose
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

LITERATURE = "literature.toml"  # has a reader of its own, with more to tell of splittings


def files() -> list[Path]:
    """One a library."""
    folder = content("reports", "audits")
    return [path for path in sorted(folder.glob("*.toml")) if path.name != LITERATURE]


def claims_of(found: TableFile) -> Iterator[ClaimResult]:
    """The claims of a library's tables."""
    entries = {entry.name: entry for entry, _ in found.entries}
    for each in found.judged():
        yield _claim(found.title, entries[each.table], each)


def _claim(title: str, entry: TableEntry, found: Judgement) -> ClaimResult:
    claim = found.claim
    cost = f". It costs {claim.cost.said}" if claim.cost and claim.cost.said else ""
    return ClaimResult(
        id=f"{title.split()[0]}/{found.id}",
        kind=claim.kind,
        source=entry.name,
        section=f"{title}, printed tables",
        statement=prose(f"{claim.statement} ({entry.source})"),
        scene="",
        verdict=claim.verdict,
        evidence=prose(claim.evidence, cost, f". Read in {entry.read}"),
        details=tuple(tuple(map(prose, row)) for row in claim.details),
        severity=claim.severity or "",
        reproduction=of_clock(entry) if claim.verdict is Verdict.REFUTED else "",
    )
