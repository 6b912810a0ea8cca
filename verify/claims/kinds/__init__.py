"""The kinds of claims, one file each with a `CLAIM`, found by themselves.

`CLAIM` is a subclass of `verify.claims.base_claim.Claim`, or of one of the bases beside it
(`formula_claims`, `quantified_claims`, `orders`, `run_claims`, `region_claims`), whose `kind` is a
Literal of the names that a claims file has for it. Adding a kind is adding a file.
"""

from collections.abc import Mapping
from functools import cache
from typing import get_args

from verify.claims.base_claim import Claim
from verify.discovery import Catalogue

_FILES = Catalogue(__name__, __path__)


@cache
def models() -> Mapping[str, type[Claim]]:
    """Return the model of each kind, by the kind's name, in alphabetical order."""
    kinds = [
        (kind, model)
        for model in (_FILES.module(file).CLAIM for file in _FILES.names)
        for kind in get_args(model.model_fields["kind"].annotation)
    ]
    return dict(sorted(kinds, key=lambda entry: entry[0]))
