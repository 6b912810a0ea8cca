"""Rows of a section's tables; the macros `rows` and `groups` set them."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup


@dataclass(frozen=True)
class Row:
    """`cells` stand beside the `label`; a `failure` takes the place of those that are not there."""

    label: str
    cells: Sequence[str | Markup]
    failure: str = ""


@dataclass(frozen=True)
class Group:
    """Rows below a heading, and what is said `about` them beside it."""

    label: str
    rows: Sequence[Row]
    about: str = ""
