"""The second look at every printed table of libraries, right and wrong, beside the first.

    python -m tests.campaigns.audit

Where an order is proved, enclosed or measured, the steps at 60 digits must not show a lower one;
where it is refuted, they must. Anything else is listed and ends with status 1. It takes a quarter
of an hour.
"""

import sys
import time

from verify.audits.library_claims import files
from verify.audits.second_look import OF_ORDERS, claimed_of, look_at_table
from verify.integrators.tables.table_file import read_tables
from verify.verdict import Verdict

ORDERS = ("order", "order in time", "embedded order")


def main() -> int:
    """The status: 1 where the two do not agree."""
    right, wrong, unseen, problems = 0, 0, 0, []
    for path in files():
        begun, found = time.perf_counter(), read_tables(path)
        entries = {entry.name: entry for entry, _ in found.entries}
        for each in found.judge():
            entry, claim = entries[each.table], each.claim
            claimed = claimed_of(entry, claim.kind)
            plain = claim.kind.partition(", ")[0]
            if plain not in ORDERS or claimed is None or claim.verdict is Verdict.UNDECIDED:
                continue
            look = look_at_table(entry, claim.kind, claimed)
            if not look.slopes:
                unseen += 1
            elif claim.verdict is Verdict.REFUTED and claim.severity in OF_ORDERS:
                wrong += 1
                problems += [] if look.confirms else [f"{each.id}: refuted, and {look.sentence}"]
            elif claim.verdict is not Verdict.REFUTED:
                right += 1
                problems += [f"{each.id}: right, and {look.sentence}"] if look.confirms else []
        print(f"{found.title}: {time.perf_counter() - begun:.0f} s", flush=True)
    print(f"{right} right and {wrong} wrong orders looked at twice, {unseen} of kinds once only")
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
