"""The studies, one a file, each with its `STUDY`."""

from verify.discovery import Catalogue
from verify.execution.plan import Study

_FILES = Catalogue(__name__, __path__)


def studies() -> list[Study]:
    """Return all studies, in the order in which their tasks are requested.

    >>> [part.what for part in studies()[1].sections]
    ['proofs for every H']
    """
    every_study: list[Study] = [_FILES.module(name).STUDY for name in _FILES.names]
    return sorted(every_study, key=lambda study: study.order)
