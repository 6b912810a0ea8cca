"""Twelve classical methods and what a step of each keeps: every row is proved when it is built."""

from docs._generate.classical_methods import METHODS, kept_exactly, kept_up_to, proved
from docs._generate.markdown import code, table

_HEAD = ("method", "for", "keeps exactly", "in one step but for", "agrees with")


def text() -> str:
    """A table with a row for each method."""
    return table(_HEAD, (_row(k) for k in range(len(METHODS))))


def _row(k: int) -> tuple[str, ...]:
    method = METHODS[k]
    proofs = proved()[method.name]
    plain = {*"()*/+"}
    exact, other = (
        "; ".join(code(x) if plain & {*x} else x for x in rows)
        for rows in (kept_exactly(proofs), kept_up_to(proofs))
    )
    return method.name, method.of, exact, other, method.agrees
