"""Certificates in which the same function has two names, as no prover of ours writes them."""

from typing import Any

from verify.proof.assistant.factors import Reducer
from verify.proof.certificates.checker import Identities
from verify.proof.certificates.entries import read
from verify.proof.certificates.readers import Poly


class _Gaps(Identities):
    """What the small checker asks to be 0, by the names that it has for cofactors of it."""

    def zero(self, x: Poly, what: str) -> None:
        self.gaps[what] = x

    def collected(self) -> dict[str, Poly]:
        self.gaps: dict[str, Poly] = {}
        self.check()
        return self.gaps


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
    gaps = _Gaps(entries)  # type: ignore[arg-type]
    found, made = gaps.collected(), [f.name for f in gaps.given.functions]
    names = [*reversed(made), *gaps.given.coordinates, "t", *gaps.given.parameters]
    relations = [(made.index(n), gaps.relations[n]) for n in reversed(made) if n in gaps.relations]
    reducer = Reducer(names, relations)
    return {
        what: {made[k]: _written(factor) for k, factor in reducer.factors(gap)}
        for what, gap in found.items()
        if gap
    }


def _written(x: Poly) -> list[list[str]]:
    return [[str(c), *names] for names, c in x.items()]
