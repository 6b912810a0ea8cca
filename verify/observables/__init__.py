"""The observables of a run besides its last state: `kinds/` has one observable a file.

A file of `kinds/` defines `OBSERVABLE`, all that any other room needs of that observable: for a
kernel, a proof, a certificate, in scenes and on pages.
"""

from collections.abc import Container
from functools import cache

from verify.discovery import Catalogue
from verify.observables.observable import Observable

_FILES = Catalogue(f"{__name__}.kinds", [f"{folder}/kinds" for folder in __path__])


@cache
def by_name() -> dict[str, Observable]:
    """Return all observables by their names, in the order in which they are shown."""
    kinds = [_FILES.module(name).OBSERVABLE for name in _FILES.names]
    return {kind.name: kind for kind in sorted(kinds, key=lambda kind: kind.order)}


def select(names: Container[str]) -> list[Observable]:
    """Return the observables whose names are requested, in the same order."""
    return [observable for name, observable in by_name().items() if name in names]
