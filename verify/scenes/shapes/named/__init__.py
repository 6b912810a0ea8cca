"""The named shapes, one file each with a `SHAPE`, found by themselves."""

from typing import TYPE_CHECKING

from verify.discovery import Catalogue
from verify.errors import unknown

if TYPE_CHECKING:
    from verify.scenes.shapes.outline import Shape

_FILES = Catalogue(__name__, __path__)


def names() -> tuple[str, ...]:
    """The names of all shapes."""
    return _FILES.names


def get(name: str) -> "Shape":
    """The shape of that name; InputError where there is none."""
    if name not in _FILES:
        raise unknown("shape", name, names())
    shape: Shape = _FILES.module(name).SHAPE
    return shape
