"""The observables of a run besides its last state: `kinds/` has one observable a file.

A file of `kinds/` defines `OBSERVABLE`, all that any other room needs of that observable: for a
kernel, a proof, a certificate, in scenes and on pages. A file of `families/` defines `member`, of
as many observables as there are texts: `integral_error: q1*p2 - q2*p1`. Names are all that tasks
and results store.
"""

from collections.abc import Collection
from functools import cache, lru_cache

from verify.discovery import Catalogue
from verify.observables.observable import Observable

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])
_FAMILIES = Catalogue(f"{__name__}.families", [f"{folder}/families" for folder in __path__])


@cache
def by_name() -> dict[str, Observable]:
    """Return all observables that are no members of a family by their names, in the order in which
    they are shown."""
    kinds = [_FILES.module(name).OBSERVABLE for name in _FILES.names]
    return {kind.name: kind for kind in sorted(kinds, key=lambda kind: kind.order)}


def find(name: str) -> Observable | None:
    """Return the observable of that name, which may be a member of a family; None if there is
    none."""
    return by_name().get(name) or _member(name)


@lru_cache(maxsize=256)
def _member(name: str) -> Observable | None:
    family, colon, text = name.partition(":")
    file = family.replace("_", "-")
    if not colon or not text.strip() or file not in _FAMILIES:
        return None
    member: Observable = _FAMILIES.module(file).member(text.strip())
    return member


def select(names: Collection[str]) -> list[Observable]:
    """Return the observables whose names are requested: kinds first, then members by name."""
    kinds = [observable for name, observable in by_name().items() if name in names]
    others = (find(name) for name in sorted({*names}.difference(by_name())))
    return kinds + [each for each in others if each is not None]
