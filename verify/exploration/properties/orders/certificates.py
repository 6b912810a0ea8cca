"""The certificate of a proof is accepted by its checker, and refused with one number changed.

The number is one of the leading coefficient, or of the first power of h in a coordinate's new
value. Only one sample in ten is checked, as the checker, which works with plain dictionaries, is
slow.
"""

import json
from collections.abc import Mapping
from typing import Any

from verify.errors import InputError
from verify.exploration.property import Violation, only_if, silent_at
from verify.exploration.sample import Sample
from verify.proof.certificates.certification import certify_for_one_h
from verify.proof.certificates.checker import check

_MAX_CHARACTERS = 20_000  # of a certificate; longer ones take long to check


def holds(sample: Sample) -> None:
    only_if(sample.is_turn(one_in=10) and sample.in_closed_form)
    with silent_at(InputError):  # such a map, or such functions, have no certificate
        data = certify_for_one_h(sample.proof, sample.potential)
    only_if(len(json.dumps(data)) <= _MAX_CHARACTERS)
    if sample.hamiltonian.planar:  # certificates in the plane have another form
        _must_be_checked(data, data["leading"], {n: data[n] for n in ("p_next", "q_next")})
    else:
        leading = data["leading"][0][2] if data["leading"] else []
        _must_be_checked(data, leading, data["next"])


def _must_be_checked(
    data: dict[str, Any], leading: list[Any], after: Mapping[str, list[list[Any]]]
) -> None:
    """Raise Violation if the certificate is refused, or if it is accepted with a changed number.

    The number is the first term of the leading coefficient, or of h¹ in a coordinate's new value,
    by which the map agrees with the flow. After a change of a higher power the certificate might
    still be true, for another map.
    """
    if refused := _refusal(data):
        raise Violation(f"the certificate is refused: {refused}")
    first = {name: [*coefficients, [], []][1] for name, coefficients in after.items()}
    for name, terms in {"leading": leading, **first}.items():
        if not terms:
            continue
        # A zero appended to the number's text changes it by a factor of ten.
        terms[0][0], true = f"{terms[0][0]}0", terms[0][0]
        accepted = not _refusal(data)
        terms[0][0] = true
        if accepted:
            raise Violation(f"with a number of {name} changed the certificate is accepted")


def _refusal(data: dict[str, Any]) -> str:
    """Return the reason why the checker refuses the certificate; "" if it accepts it."""
    try:
        check(data)
    except ValueError as error:
        return str(error)
    return ""
