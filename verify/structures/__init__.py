"""The structures that a step should preserve: area in the plane, the symplectic form in general.

Each is one object in a file of its own. Code asks the object for what differs between the two, and
not for the number of degrees of freedom.
"""

from verify.structures.area import AREA
from verify.structures.structure import Structure
from verify.structures.symplectic import SYMPLECTIC

__all__ = ["AREA", "SYMPLECTIC", "Structure", "structure_in"]


def structure_in(degrees: int) -> Structure:
    """Return the structure that a canonical step preserves in so many degrees of freedom."""
    return AREA if degrees == 1 else SYMPLECTIC
