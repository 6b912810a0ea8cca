"""Identities as people print them, each with a false twin: which are decided, and how fast.

    python -m tests.campaigns.identities --count 100 --seed 1

Of every sort so many are drawn. Wrong is a true one that is called false, and a false one that is
called true; either ends with status 1. What is left undecided is counted, and listed.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

from tests.helpers.sampled.identities.drawn import SORTS, Identity, identities
from verify.algebra.embedding import embed
from verify.algebra.formula import parse
from verify.errors import InputError


@dataclass
class Tally:
    """What became of one sort's identities; `slowest` in seconds."""

    wrong: list[str] = field(default_factory=list)
    undecided: list[str] = field(default_factory=list)
    twins_undecided: list[str] = field(default_factory=list)
    slowest: float = 0.0


def decided(text: str) -> bool | None:
    """Whether the formula is zero; None where that is undecided, or the formula is refused."""
    try:
        expression = parse(text)
        names = sorted(map(str, expression.free_symbols))
        ring, (x,) = embed([expression], names)
        return ring.decide(x).zero
    except InputError:
        return None


def tally(drawn: Sequence[Identity]) -> Tally:
    """Decides each of them and its twin."""
    found = Tally()
    for identity in drawn:
        for text, true in ((identity.true, True), (identity.false, False)):
            began = time.perf_counter()
            zero = decided(text)
            found.slowest = max(found.slowest, time.perf_counter() - began)
            if zero is None:
                (found.undecided if true else found.twins_undecided).append(text)
            elif zero is not true:
                found.wrong.append(text)
    return found


def main() -> int:
    """The status: 1 where something was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="identities of each sort")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    status = 0
    for sort in SORTS:
        found = tally(identities(sort, options.count, options.seed))
        left = f"{len(found.undecided)} undecided, {len(found.twins_undecided)} twins undecided"
        print(f"{sort}: {len(found.wrong)} wrong, {left}; slowest {found.slowest:.2f} s")
        for text in found.wrong:
            print(f"  wrong: {text}")
        for text in (*found.undecided, *found.twins_undecided):
            print(f"  undecided: {text}")
        status |= bool(found.wrong)
    return status


if __name__ == "__main__":
    sys.exit(main())
