"""What a step is meant to keep: area in the plane, the symplectic form in n degrees of freedom.

One object a file, and all that is asked of it in that object. What differs between the two is asked
of it, in place of how many degrees of freedom there are.
"""

from verify.structures.area import AREA
from verify.structures.structure import Structure
from verify.structures.symplectic import SYMPLECTIC

__all__ = ["AREA", "SYMPLECTIC", "Structure", "structure_in"]


def structure_in(degrees: int) -> Structure:
    """What a canonical step keeps in so many degrees of freedom."""
    return AREA if degrees == 1 else SYMPLECTIC
