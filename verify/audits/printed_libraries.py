"""Tables that libraries have in their sources: a TOML file for each in `reports/audits`.

The files are those that `verify check-table` takes; `title` is the library with its version. The
results are reported as those of any other integrator.
"""

from collections.abc import Iterator
from functools import partial
from itertools import groupby
from pathlib import Path

from verify.audits.claims import result_of, separate
from verify.audits.reproductions import write_clock_program
from verify.audits.second.look import at_claim
from verify.content import content
from verify.integrators.tables.check import TableFile
from verify.integrators.tables.entry import TableEntry
from verify.integrators.tables.table_claim import TableClaim
from verify.scenes.results.claim import ClaimResult
from verify.verdict import Verdict

LITERATURE = "literature.toml"  # has a reader of its own, with more to tell of splittings


def files() -> list[Path]:
    """Return the files, one a library."""
    folder = content("reports", "audits")
    return [path for path in sorted(folder.glob("*.toml")) if path.name != LITERATURE]


def claims_of(table_file: TableFile) -> Iterator[ClaimResult]:
    """Yield the claims of a library's tables."""
    entries = {entry.name: entry for entry, _ in table_file.entries}
    for table, judged in groupby(table_file.judge(), key=lambda each: each.table):
        for claim in separate(each.claim for each in judged):
            yield _claim(table_file.title, entries[table], claim)


def _claim(title: str, entry: TableEntry, claim: TableClaim) -> ClaimResult:
    cost = f". It costs {claim.cost.sentence}" if claim.cost and claim.cost.sentence else ""
    result = result_of(
        claim, title.split()[0], entry.name, f"{title}, printed tables", entry.source,
        f"{cost}. Read in {entry.read}", partial(at_claim, entry, claim.kind),
    )  # fmt: skip
    refuted = result.verdict is Verdict.REFUTED
    return result.model_copy(update={"reproduction": write_clock_program(entry) if refuted else ""})
