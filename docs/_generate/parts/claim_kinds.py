"""The kinds of claims: what each states, and its keys."""

import inspect
import sys
from collections.abc import Iterator

from docs._generate.keys import keys
from docs._generate.markdown import prose
from verify.claims.base_claim import Claim
from verify.claims.claim_scenes import ClaimedHamiltonian
from verify.claims.kinds import models
from verify.claims.run_claims import RunKeys


def text() -> str:
    """The keys that all have, those of H and of runs, and a section for each kind."""
    return "\n".join(
        [
            f"## Keys of every claim\n\n{keys(Claim)}",
            f"## Keys of H\n\n{_OF_H}\n\n{keys(ClaimedHamiltonian)}",
            f"## Keys of runs\n\n{_OF_RUNS}\n\n{keys(RunKeys)}",
            "## Kinds\n",
            *("\n\n".join(_section(kind, model)) for kind, model in models().items()),
        ]
    )


_OF_H = (
    "A claim says of which H it speaks by one of these, by `scene`, or by `every` where it has it."
)
_OF_RUNS = (
    "A claim that is decided by runs says of which; what it does not say, those of its scene say."
)


def _section(kind: str, model: type[Claim]) -> Iterator[str]:
    yield f"### {kind}"
    yield prose(inspect.cleandoc(sys.modules[model.__module__].__doc__ or ""))
    yield "It is decided by " + ("algebra." if model.exact else "runs.")
    without = [key for key in model.model_fields if not _is_own(model, key)]
    if len(without) < len(model.model_fields):
        yield keys(model, without)


def _is_own(model: type[Claim], key: str) -> bool:
    """Whether the kind has the key, or takes something else there than every claim does."""
    bases = model.__mro__[: model.__mro__.index(Claim)]
    return key != "kind" and any(key in inspect.get_annotations(base) for base in bases)
