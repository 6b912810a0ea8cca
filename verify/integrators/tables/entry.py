"""What tables of every kind may have: their keys, and numbers as they are written."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PrivateAttr, StrictBool, StringConstraints

from verify.integrators.tables.signs import LONGEST, plain
from verify.scenes.frozen import Frozen


def written(value: Any) -> Any:
    """A number as the file has it, in our signs; what is no text or whole number stays as it is."""
    if isinstance(value, bool):
        return value
    if isinstance(value, int):
        return str(value)
    return plain(value) if isinstance(value, str) and len(value) <= LONGEST else value


Written = Annotated[str, StringConstraints(max_length=LONGEST), BeforeValidator(written)]
Row = tuple[Written, ...]
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
    numbers: dict[str, Written] = Field(default_factory=dict)
    symplectic: StrictBool = False
    symmetric: StrictBool = False
    csv: str | None = None
    _folder: Path = PrivateAttr(default=Path())

    def in_folder(self, folder: Path) -> "TableEntry":
        """The same, with files that lie beside it in that folder."""
        self._folder = folder
        return self

    @property
    def folder(self) -> Path:
        """Where its files lie."""
        return self._folder
