"""The certificate of a proof is accepted by its checker, and refused with one number changed.

The number is one of the leading coefficient, or of the first power of h in p' or q'. One sample in
a few is looked at, as the checker works with plain dictionaries.
"""

import json
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.proof.certificates.checker import check
from verify.proof.certificates.one import of_one
from verify.proof.potential import potential_of

_IN = 10  # one in so many samples
_LONGEST = 400  # terms in a certificate that is checked here


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(_IN) and sample.ordinary and not sample.step_map.implicit)
    proof = sample.proof
    with silent_at(InputError):  # such a map, or such functions, have no certificate
        data = of_one(proof, potential_of(proof, sample.scheme))
    entries = (entry for name in ("p_next", "q_next", "leading") for entry in data[name])
    only_if(sum(map(len, entries)) <= _LONGEST)
    refused = _refused(data)
    if refused:
        raise Violation(f"the certificate is refused: {refused}")
    for name in ("leading", "p_next", "q_next"):
        changed = _changed(data, name)
        if changed is not None and not _refused(changed):
            raise Violation(f"with a number of {name} changed the certificate is accepted")


def _refused(data: dict[str, Any]) -> str:
    """Why it is; empty where it is accepted."""
    try:
        check(data)
    except ValueError as error:
        return str(error)
    return ""


def _changed(data: dict[str, Any], name: str) -> dict[str, Any] | None:
    """A copy with a zero added to a number of that entry; None where it has none.

    Of p' and q' it is one of h¹, by which the map agrees with the flow: with one of a higher power
    the certificate might be that of another map, of which it says the truth.
    """
    copied: dict[str, Any] = json.loads(json.dumps(data))
    terms = copied[name] if name == "leading" else [*copied[name], [], []][1]
    if not terms:
        return None
    terms[0][0] = f"{terms[0][0]}0"
    return copied
