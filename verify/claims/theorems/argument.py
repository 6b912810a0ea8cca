"""A theorem of a paper with its verdict, its proof in words, and what a machine checked of it."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from verify.prose import Prose, read_prose
from verify.verdict import Verdict


@dataclass(frozen=True)
class Check:
    """One exact fact that an argument rests on; `shown` is its value in a few words.

    Both are written as `read_prose` takes them, with formulas quoted.
    """

    what: str
    holds: bool
    shown: str


@dataclass(frozen=True)
class Argument:
    """A verdict on what the claim of that name states, and the argument for it.

    `evidence` is one line; `proof` a paragraph that can be quoted; `details` a table, whose first
    row is its head: the facts that were computed.
    """

    id: str
    verdict: Verdict
    evidence: Prose
    proof: Prose
    details: tuple[tuple[Prose, ...], ...]


HEAD = ("what the argument rests on", "value", "checked")


def concluded(
    name: str,
    verdict: Verdict,
    evidence: str,
    proof: str,
    checks: Iterable[Check],
) -> Argument:
    """The argument, where every check holds; else it shows nothing, and is UNDECIDED.

    A wrong counterexample refutes nothing, and a proof with a wrong step proves nothing. All texts
    are written as `read_prose` takes them, with formulas quoted.
    """
    found = tuple(checks)
    rows = [(c.what, c.shown, "holds" if c.holds else "does not hold") for c in found]
    failed = [c for c in found if not c.holds]
    if failed or not found:
        verdict = Verdict.UNDECIDED
        evidence = f"the argument fails at: {failed[0].what}" if failed else "nothing was checked"
        proof = ""
    return Argument(
        id=name,
        verdict=verdict,
        evidence=read_prose(evidence),
        proof=read_prose(" ".join(proof.split())),
        details=tuple(tuple(map(read_prose, row)) for row in (HEAD, *rows)),
    )


def vanishes(what: str, *elements: Any) -> Check:
    """The check that polynomials in normal form are zero."""
    wrong = [x for x in elements if x != 0]
    return Check(what, not wrong, "0" if not wrong else f"{len(wrong[0])} terms are left")
