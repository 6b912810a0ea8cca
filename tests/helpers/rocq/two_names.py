"""Certificates in which the same function has two names, as no prover of ours writes them."""

from typing import Any

from verify.proof.assistant.factors import Reducer
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import read
from verify.proof.certificates.readers import Poly


def with_square(data: dict[str, Any], name: str, new: str, argument: Any) -> dict[str, Any]:
    """The certificate with `new` = 1/argument for the square of `name`, and its cofactors."""
    changed = {key: _replaced(value, name, new) for key, value in data.items()}
    changed["functions"] = [*data["functions"], [new, "inverse", argument]]
    changed["cofactors"] = _cofactors(changed)
    return changed


def _replaced(entry: Any, name: str, new: str) -> Any:
    """The entry with one pair of that name in each term replaced."""
    if isinstance(entry, dict):
        return {key: _replaced(value, name, new) for key, value in entry.items()}
    if not isinstance(entry, list):
        return entry
    if entry.count(name) < 2:
        return [_replaced(value, name, new) for value in entry]
    rest = list(entry)
    rest.remove(name)
    rest.remove(name)
    return [*rest, new]


def _cofactors(data: dict[str, Any]) -> dict[str, Any]:
    entries = read({**data, "cofactors": {}})
    assert not isinstance(entries, tuple)
    asked = Identities(entries)  # type: ignore[arg-type]
    made, relations = [f.name for f in asked.entries.functions], asked.relations
    names = [*reversed(made), *asked.entries.coordinates, "t", *asked.entries.parameters]
    numbered = [(made.index(n), relations[n]) for n in reversed(made) if n in relations]
    reducer = Reducer(names, numbered)
    return {
        what: {made[k]: _written(factor) for k, factor in reducer.factors(gap)}
        for what, gap in asked.residuals()
        if gap
    }


def _written(x: Poly) -> list[list[str]]:
    return [[str(c), *names] for names, c in x.items()]
