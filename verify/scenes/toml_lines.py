"""On which lines of a TOML text its tables and keys stand, which `tomllib` does not tell.

The text must have been read by `tomllib`: here it is only cut into statements, so that a bracket or
a `#` in a string, and a value over several lines, mislead nobody.
"""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

MAX_DEPTH = 12
_KEY = r"""(?:[\w-]++|"(?:\\.|[^"\\\n])*+"|'[^'\n]*+')"""
# A key of too many parts; a text, to the end of the line or the file where it is not ended; a
# comment; a word. A text that ends in quotes has up to five in a row at its end.
PIECE = re.compile(
    rf"(?P<deep>{_KEY}(?:[ \t]*+\.[ \t]*+{_KEY}){{{MAX_DEPTH},}}+)"
    r'|"""(?s:\\.|(?!""")[^\\])*+"{0,5}+'
    r"|'''(?s:(?!''').)*+'{0,5}+"
    r'|"(?:\\.|[^"\\\n])*+"?+'
    r"|'[^'\n]*+'?+"
    r"|\#[^\n]*+"
    r"|[\w-]++"
    r"|(?s:.)"
)


@dataclass
class Table:
    """One table of the file: the line of its header, and of each key in it."""

    line: int
    keys: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Lines:
    """The tables by name; those of an array of tables in their order. The root is under ""."""

    tables: dict[str, list[Table]]

    def of(self, name: str, index: int = 0, *keys: str) -> int | None:
        """The line of the first of these keys that is there, else of the table's header."""
        tables = self.tables.get(name, [])
        if index >= len(tables):
            return self.tables[""][0].keys.get(name)  # written as one value: name = [{…}, …]
        table = tables[index]
        return next((table.keys[key] for key in keys if key in table.keys), table.line)

    def has(self, name: str, index: int, key: str) -> bool:
        """Whether that table, the root under "", has the key."""
        tables = self.tables.get(name, [])
        return index < len(tables) and key in tables[index].keys


def lines_of(text: str) -> Lines:
    """The lines, counted from 1, of a text that `tomllib` reads."""
    tables: dict[str, list[Table]] = {"": [Table(1)]}
    table, inside = tables[""][0], ""
    for line, statement in _statements(text):
        if statement.startswith("["):
            path = list(_path(statement))
            if len(path) == 1:
                table, inside = Table(line), ""
                tables.setdefault(path[0], []).append(table)
            else:  # [claim.parameters] is a key of the last claim
                inside = path[1]
                table = tables.setdefault(path[0], [Table(line)])[-1]
                table.keys.setdefault(inside, line)
        elif not inside:
            table.keys.setdefault(next(_path(f"{_key(statement)} = 0")), line)
    return Lines(tables)


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Each header, and each key with its value, with the line that it begins on."""
    line, begun, depth, parts = 1, 1, 0, ""
    header = False
    for piece in _pieces(text.replace("\r\n", "\n") + "\n"):
        if piece == "\n" and (depth == 0 or header):
            if parts.strip():
                yield begun, parts.strip()
            parts, depth, header = "", 0, False
        elif not piece.startswith("#"):
            if not parts.strip():
                begun, parts = line, ""
                header = piece == "["
            depth += {"[": 1, "{": 1, "]": -1, "}": -1}.get(piece, 0)
            parts += piece
        line += piece.count("\n")


def _pieces(text: str) -> Iterator[str]:
    return (piece[0] for piece in PIECE.finditer(text))


def _key(statement: str) -> str:
    """What stands before the = of a key with its value."""
    key = ""
    for piece in _pieces(statement):
        if piece == "=":
            break
        key += piece
    return key


def _path(statement: str) -> Iterator[str]:
    """The names of a header or of a dotted key, from the outside in."""
    value: Any = tomllib.loads(statement)
    while value:
        value = value[0] if isinstance(value, list) else value
        if not isinstance(value, dict) or not value:
            return
        name, value = next(iter(value.items()))
        yield name
