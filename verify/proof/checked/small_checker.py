"""The mark of the small checker: a certificate of the proof, made and accepted in this run."""

import re
from collections.abc import Iterator

from verify.effort import limit_effort
from verify.errors import InputError
from verify.proof.certificates.established import EstablishedStatement, check_certificate
from verify.proof.checked.proved import ProvedStatement
from verify.prose import Formula, Prose, prose, read_prose

_POWER = re.compile(r"h\^[0-9]+")
_CERTIFIED = {"defect", "map", "telescopes"}
_SHORT = 60  # characters of a leading coefficient that is quoted


def marks(proved: ProvedStatement) -> Iterator[Prose]:
    """Yield the statement of the first certificate that can be made, if the checker accepts it."""
    if not (_CERTIFIED & proved.about) and not ("volume" in proved.about and proved.preserves):
        return
    for make in proved.certificates:
        try:
            with limit_effort("proof", proved.scheme.name, "to certify it"):
                result = check_certificate(make())
        except InputError:  # of this proof there is none
            continue
        if isinstance(result, EstablishedStatement):
            yield prose("small checker: ", read_prose(_statement(result)), _leading(result))
        return


def _statement(result: EstablishedStatement) -> str:
    """Return the statement with the powers of h marked as formulas."""
    return _POWER.sub(r"`\g<0>`", result.statement)


def _leading(result: EstablishedStatement) -> Prose:
    """Quote L where it is short; else nothing."""
    if result.leading is None or len(result.leading) > _SHORT:
        return Prose()
    return prose("; L = ", Formula(result.leading))
