"""The certificate of a proof is accepted by its checker, and refused with one number changed.

The number is one of the leading coefficient, or of the first power of h in p' or q'. One sample in
a few is looked at, as the checker works with plain dictionaries.
"""

import json
from collections.abc import Iterator
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.exploration.sample_in_degrees import SampleInDegrees
from verify.proof.certificates.checker import check
from verify.proof.certificates.one import of_one
from verify.proof.certificates.several import of_one_in_degrees
from verify.proof.potential import potential_of

_IN = 10  # one in so many samples
_IN_DEGREES = 6
_LONGEST_IN_DEGREES = 20_000  # characters
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


def holds_in_degrees(sample: SampleInDegrees) -> None:
    """The numbers are one of S, and one of h¹ in a coordinate's new value."""
    only_if(sample.is_turn(_IN_DEGREES) and sample.ordinary and not sample.step_map.implicit)
    with silent_at(InputError):  # such a map, or such functions, have no certificate
        data = of_one_in_degrees(sample.proof, sample.hamiltonian, sample.scheme)
    only_if(len(json.dumps(data)) <= _LONGEST_IN_DEGREES)
    refused = _refused(data)
    if refused:
        raise Violation(f"the certificate is refused: {refused}")
    for name, terms in _numbers_of(data):
        terms[0][0], true = f"{terms[0][0]}0", terms[0][0]
        accepted = not _refused(data)
        terms[0][0] = true
        if accepted:
            raise Violation(f"with a number of {name} changed the certificate is accepted")


def _numbers_of(data: dict[str, Any]) -> Iterator[tuple[str, list[Any]]]:
    """Polynomials of the certificate that are not 0: the first entry of S, each of h¹."""
    if data["leading"]:
        yield "leading", data["leading"][0][2]
    for name, coefficients in data["next"].items():
        terms = [*coefficients, [], []][1]
        if terms:
            yield name, terms
