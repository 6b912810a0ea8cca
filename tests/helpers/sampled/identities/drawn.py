"""Identities as people print them, drawn at random, each with a twin that is false.

An identity is a formula that is 0 wherever it is defined; it is written from textbook rules and by
Python's own integers, so that nothing of it comes from the code that decides it. Its twin differs
by a small exact amount.
"""

from dataclasses import dataclass
from random import Random

from tests.helpers.sampled.identities import (
    arctangents,
    hyperbolic,
    logarithms,
    parts_of_a_turn,
    phases,
    roots,
)
from tests.helpers.sampled.identities.parts import Draw

SORTS: dict[str, tuple[Draw, ...]] = {
    "phases": phases.DRAWS,
    "parts of a turn": parts_of_a_turn.DRAWS,
    "logarithms": logarithms.DRAWS,
    "roots": roots.DRAWS,
    "hyperbolic functions of logarithms": hyperbolic.DRAWS,
    "arctangents": arctangents.DRAWS,
}

# Is 0 for every q, and is not decided.
HIDDEN = "sqrt(1 + 2*q**2 + 2*q*sqrt(1 + q**2)) - q - sqrt(1 + q**2)"


@dataclass(frozen=True)
class Identity:
    """A formula that is 0, and one that is not."""

    true: str
    false: str


def identities(sort: str, count: int, seed: int) -> list[Identity]:
    """So many of one of the `SORTS`."""
    rng = Random(f"{sort} {seed}")  # noqa: S311 - no secret
    return [drawn_identity(sort, rng) for _ in range(count)]


def drawn_identity(sort: str, rng: Random) -> Identity:
    """One of that sort."""
    true = rng.choice(SORTS[sort])(rng)
    amount = f"{rng.choice((1, 2, 3, 7))}/10**{rng.randint(4, 60)}"
    factor = rng.choice(("", "*(1+q**2)", "*exp(q)", "*pi"))
    return Identity(true, f"{true} {rng.choice('+-')} {amount}{factor}")
