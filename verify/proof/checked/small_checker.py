"""The mark of the small checker: a certificate of the proof, made and accepted in this run."""

import re
from collections.abc import Iterator

from verify.effort import limited
from verify.errors import InputError
from verify.proof.certificates.established import Established, accepted
from verify.proof.checked.proved import Proved
from verify.prose import Formula, Prose, prose, read_prose

_POWER = re.compile(r"h\^[0-9]+")
_CERTIFIED = {"defect", "map", "telescopes"}
_SHORT = 60  # characters of a leading coefficient that is told


def marks(proved: Proved) -> Iterator[Prose]:
    """What the first certificate that can be made establishes; nothing where none can, and nothing
    where the checker refuses it."""
    if not (_CERTIFIED & proved.about) and not ("volume" in proved.about and proved.preserves):
        return
    for made in proved.certificates:
        try:
            with limited("proof", proved.scheme.name, "to certify it"):
                found = accepted(made())
        except InputError:  # of this proof there is none
            continue
        if isinstance(found, Established):
            yield prose("small checker: ", read_prose(_statement(found)), _leading(found))
        return


def _statement(found: Established) -> str:
    """Its own words, with the powers of h as formulas."""
    return _POWER.sub(r"`\g<0>`", found.statement)


def _leading(found: Established) -> Prose:
    """L itself, where it is short."""
    if found.leading is None or len(found.leading) > _SHORT:
        return Prose()
    return prose("; L = ", Formula(found.leading))
