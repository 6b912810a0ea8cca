"""The named shapes, each a file with a `SHAPE`, which a catalogue finds."""

from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import unknown_name

if TYPE_CHECKING:
    from verify.scenes.shapes.outline import Shape

_FILES = Catalogue(__name__, __path__)


def names() -> tuple[str, ...]:
    """Return the names of all shapes."""
    return _FILES.names


def get(name: str) -> "Shape":
    """Return the shape of that name; InputError if there is none."""
    if name not in _FILES:
        raise unknown_name("shape", name, names())
    shape: Shape = _FILES.module(name).SHAPE
    return shape
