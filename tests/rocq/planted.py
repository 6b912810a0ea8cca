"""One thing changed in an exported text, and where Rocq has to stop for it."""

from dataclasses import dataclass

import pytest

from tests.helpers.rocq.coqc import changed
from tests.helpers.rocq.exports import export
from tests.helpers.rocq.session import Session


@dataclass(frozen=True)
class Planted:
    """`edits`: (old, new), or with how often the old stands; `place`: what is then not proved.

    That the export is taken without them is held by `test_exports`.
    """

    what: str
    export: str
    place: str
    edits: tuple[tuple[str, str] | tuple[str, str, int], ...]

    def text(self) -> str:
        """The export with what is planted."""
        found = export(self.export).text
        for edit in self.edits:
            found = changed(found, *edit)
        return found


def planted(
    what: str, name: str, place: str, *edits: tuple[str, str] | tuple[str, str, int]
) -> object:
    """A parameter of a test, called after what is planted where.

    A sample has each export and each place before it has one of them again.
    """
    return pytest.param(Planted(what, name, place, edits), id=f"{name}-{place}-{what}")


def check_refused(it: Planted, rocq: Session) -> None:
    """That Rocq stops at the place, and refuses no more than it has to."""
    place = rocq.stops_at(it.text())
    assert place == it.place, f"Rocq stops at {place}"
