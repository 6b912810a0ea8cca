"""Tables with one mistake each, drawn from right ones: which are refuted, and none wrongly.

    python -m tests.campaigns.tables --count 1000 --seed 1

A wrong digit, sign, node, clock or weight must be refuted, unless what is claimed still holds, by
power series of a step, to the digits that are printed. What is refuted must not hold by them. Right
tables must hold. Anything else is listed and ends with status 1.
"""

import argparse
import random
import sys
import time

from tests.helpers.tables.mistakes import judged, outcome, places, right_tables, with_mistake
from verify.verdict import Verdict


def main() -> int:
    """The status: 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1000, help="tables with a mistake")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    draw, tables, problems = random.Random(given.seed), right_tables(), []  # noqa: S311
    for table in tables:
        problems += [
            f"{table['name']}: {claim.kind} is refuted: {claim.evidence}"
            for claim in judged(table)
            if claim.verdict is Verdict.REFUTED and "digits" not in claim.kind
        ]
    print(f"{len(tables)} right tables")
    refuted, slowest = 0, 0.0
    for k in range(given.count):
        table = draw.choice([x for x in tables if places(x)])
        wrong, what = with_mistake(table, draw)
        began = time.perf_counter()
        found = outcome(table, wrong, what)
        slowest = max(slowest, time.perf_counter() - began)
        refuted += found.refuted
        if found.problem:
            problems.append(f"{found.what}: {found.problem}")
            print(problems[-1], flush=True)
        if (k + 1) % 100 == 0:
            print(f"{k + 1} drawn, {refuted} refuted", flush=True)
    others = given.count - refuted
    print(f"{given.count} with a mistake: {refuted} refuted, {others} hold to their digits")
    print(f"slowest with its series {slowest:.1f} s; wrong: {len(problems)}")
    print(*problems, sep="\n")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
