"""What a person has read of a mistake: the words that claim, the line to blame, and the mend.

One TOML file a finding, `reports/audits/findings/NAME.toml`. Nothing in it is taken for true: the
claims must be refuted where it is told, and the tables and programs are run again.
"""

from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from verify.content import content
from verify.scenes.frozen import Frozen
from verify.scenes.mistakes.values import one_line
from verify.scenes.toml_file import read_toml

Text = Annotated[str, Field(min_length=1, max_length=20000)]


class Changed(Frozen):
    """A printed table, by the first word of its file's title and its name; which of its claims; and
    the entries that the mend changes, by key, row and column from 1, to their texts."""

    id: Text
    kind: Text
    changes: dict[str, str] = Field(default_factory=dict)


class Description(Frozen):
    """See the module. `claims`: ids of what is refuted, with * for any text. `program` is in the
    library's `language`; `mended`, the same with the mend; `ran`: by whom it was run and when,
    unless it is run here."""

    title: Text
    library: Text
    claims: Annotated[tuple[Text, ...], Field(min_length=1)]
    quote: Text
    where: Text
    holds: Text
    blame: Text
    mend: Text
    language: Literal["python", "c", "c++", "julia"]
    program: Text
    mended: Text | None = None
    ran: str = ""
    output: str = ""
    table: tuple[Changed, ...] = ()

    def tells_of(self, claim: str) -> bool:
        """Whether it is about the claim of that id."""
        return any(fnmatchcase(_plain(claim), _plain(pattern)) for pattern in self.claims)


def _plain(text: str) -> str:
    """Without the brackets that stand for more than themselves in a pattern."""
    return text.replace("[", "(").replace("]", ")")


def folder() -> Path:
    """Where they lie."""
    return Path(content("reports", "audits", "findings"))


def descriptions() -> dict[str, Description]:
    """By name. InputError for a file that is none."""
    return {path.stem: read(path) for path in sorted(folder().glob("*.toml"))}


def read(path: Path) -> Description:
    """One of them. InputError names the file."""
    try:
        return Description.model_validate(read_toml(path))
    except ValidationError as error:
        found = one_line(error, f"finding {path.stem}", Description)
        raise found from None
