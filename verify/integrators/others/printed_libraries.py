"""Tables that libraries have in their sources: a TOML file for each in `reports/audits`.

The files are those that `verify check-table` takes; `title` is the library with its version. What
is found is told as of any other integrator of others.
"""

from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from verify.content import content
from verify.integrators.others.claims import separate
from verify.integrators.others.reproductions import of_clock
from verify.integrators.others.second.look import OF_ORDERS, at_table, claimed_of
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
    for table, judged in groupby(found.judged(), key=lambda each: each.table):
        ids = {id(each.claim): each for each in judged}
        for claim in separate(each.claim for each in ids.values()):
            yield _claim(found.title, entries[table], ids[id(claim)])


def _claim(title: str, entry: TableEntry, found: Judgement) -> ClaimResult:
    claim = found.claim
    cost = f". It costs {claim.cost.said}" if claim.cost and claim.cost.said else ""
    verdict, again = claim.verdict, ""
    claimed = claimed_of(entry, claim.kind)
    if verdict is Verdict.REFUTED and claim.severity in OF_ORDERS and claimed is not None:
        look = at_table(entry, claim.kind, claimed)
        verdict = verdict if look.shown else Verdict.UNDECIDED
        again = f"; {look.said}"
    refuted = verdict is Verdict.REFUTED
    return ClaimResult(
        id=f"{title.split()[0]}/{found.id}",
        kind=claim.kind,
        source=entry.name,
        section=f"{title}, printed tables",
        statement=prose(f"{claim.statement} ({entry.source})"),
        scene="",
        verdict=verdict,
        evidence=prose(claim.evidence, again, cost, f". Read in {entry.read}"),
        details=tuple(tuple(map(prose, row)) for row in claim.details),
        severity=(claim.severity or "") if refuted else "",
        reproduction=of_clock(entry) if refuted else "",
    )
