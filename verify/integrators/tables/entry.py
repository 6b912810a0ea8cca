"""The keys that tables of every kind may have, and numbers as they are written."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PrivateAttr, StrictBool, StringConstraints

from verify.integrators.tables.signs import LONGEST, plain
from verify.scenes.frozen import Frozen


def normalize_number(value: Any) -> Any:
    """Write a number of the file in our signs; return what is no text or whole number as it is."""
    if isinstance(value, bool):
        return value
    if isinstance(value, int):
        return str(value)
    return plain(value) if isinstance(value, str) and len(value) <= LONGEST else value


NumberText = Annotated[
    str, StringConstraints(max_length=LONGEST), BeforeValidator(normalize_number)
]
Row = tuple[NumberText, ...]
Order = Annotated[int, Field(ge=1, le=20)]


class Block(Frozen):
    """One tableau. `tableau`: pasted text, in place of the others; `csv`: the name of a file."""

    a: tuple[Row, ...] | None = None
    b: Row | None = None
    c: Row | None = None
    embedded: Row | None = None
    tableau: str | None = None
    csv: str | None = None


class TableEntry(Frozen):
    """One [[table]]: `numbers` by name, `source` who claims it, `read` where it was read."""

    name: Annotated[str, Field(min_length=1, max_length=200)]
    kind: str
    source: str = ""
    read: str = ""
    numbers: dict[str, NumberText] = Field(default_factory=dict)
    symplectic: StrictBool = False
    symmetric: StrictBool = False
    csv: str | None = None
    _folder: Path = PrivateAttr(default=Path())

    def in_folder(self, folder: Path) -> "TableEntry":
        """Return the entry with the folder in which its other files lie."""
        self._folder = folder
        return self

    @property
    def folder(self) -> Path:
        """The folder of its files."""
        return self._folder
