"""The structures that a step may keep: area, a 2-form, volume, first integrals and others.

Each is one object in a file of its own. Code asks the object for what differs between structures,
and not for the number of degrees of freedom.
"""

from verify.structures.area import AREA, PLAIN_VOLUME
from verify.structures.structure import Structure
from verify.structures.symplectic import SYMPLECTIC, CanonicalForm

__all__ = ["AREA", "PLAIN_VOLUME", "SYMPLECTIC", "CanonicalForm", "Structure", "structure_in"]


def structure_in(degrees: int) -> CanonicalForm:
    """Return the structure that a canonical step preserves in so many degrees of freedom."""
    return AREA if degrees == 1 else SYMPLECTIC
