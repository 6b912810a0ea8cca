"""Tables that libraries have in their sources: a TOML file for each in `reports/audits`.

The files are those that `verify check-table` takes; `title` is the library with its version. What
is found is told as of any other integrator of others.
"""

from collections.abc import Iterator
from functools import partial
from itertools import groupby
from pathlib import Path

from verify.audits.claims import result_of, separate
from verify.audits.reproductions import of_clock
from verify.audits.second.look import at_claim
from verify.content import content
from verify.integrators.tables.check import TableFile
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.told import TableClaim
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
        for claim in separate(each.claim for each in judged):
            yield _claim(found.title, entries[table], claim)


def _claim(title: str, entry: TableEntry, claim: TableClaim) -> ClaimResult:
    cost = f". It costs {claim.cost.said}" if claim.cost and claim.cost.said else ""
    made = result_of(
        claim, title.split()[0], entry.name, f"{title}, printed tables", entry.source,
        f"{cost}. Read in {entry.read}", partial(at_claim, entry, claim.kind),
    )  # fmt: skip
    refuted = made.verdict is Verdict.REFUTED
    return made.model_copy(update={"reproduction": of_clock(entry) if refuted else ""})
