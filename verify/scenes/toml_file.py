"""Reading of TOML texts from any source as data, in which decimals stay exact, as texts.

`tomllib` takes time and memory as the square of the number of parts of a dotted key; keys with many
parts are therefore refused before it reads. A text that is not TOML is reported with a hint on the
line where the reader stopped.

The lines of tables and keys, which `tomllib` does not report, are found by cutting a text that it
has read into statements, so that a bracket or a `#` in a string, or a value over several lines, is
not misread.
"""

import re
import tomllib
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from verify.errors import CONTROL_CHARACTERS, InputError
from verify.files import read_text

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
class TableLines:
    """A table of the file: the line of its header, and the line of each key in it."""

    line: int
    keys: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Lines:
    """The tables by name, those of an array of tables in their order; the root is under ""."""

    tables: dict[str, list[TableLines]]

    def line_of(self, name: str, index: int = 0, *keys: str) -> int | None:
        """Return the line of the first of these keys that exists, else of the table's header."""
        tables = self.tables.get(name, [])
        if index >= len(tables):
            return self.tables[""][0].keys.get(name)  # written as one value: name = [{…}, …]
        table = tables[index]
        return next((table.keys[key] for key in keys if key in table.keys), table.line)

    def has(self, name: str, index: int, key: str) -> bool:
        """Return True if the table (the root is under "") has the key."""
        tables = self.tables.get(name, [])
        return index < len(tables) and key in tables[index].keys


def lines_of(text: str) -> Lines:
    """Return the lines, counted from 1, of a text that `tomllib` has read."""
    tables: dict[str, list[TableLines]] = {"": [TableLines(1)]}
    table, subtable = tables[""][0], ""
    for line, statement in _statements(text):
        if statement.startswith("["):
            path = list(_names_in(statement))
            if len(path) == 1:
                table, subtable = TableLines(line), ""
                tables.setdefault(path[0], []).append(table)
            else:  # [claim.parameters] is a key of the last claim
                subtable = path[1]
                table = tables.setdefault(path[0], [TableLines(line)])[-1]
                table.keys.setdefault(subtable, line)
        elif not subtable:
            table.keys.setdefault(next(_names_in(f"{_key_of_statement(statement)} = 0")), line)
    return Lines(tables)


def _statements(text: str) -> Iterator[tuple[int, str]]:
    """Yield each header, and each key with its value, with the line on which it begins."""
    line, first_line, depth, parts = 1, 1, 0, ""
    header = False
    for piece in _pieces(text.replace("\r\n", "\n") + "\n"):
        if piece == "\n" and (depth == 0 or header):
            if parts.strip():
                yield first_line, parts.strip()
            parts, depth, header = "", 0, False
        elif not piece.startswith("#"):
            if not parts.strip():
                first_line, parts = line, ""
                header = piece == "["
            depth += {"[": 1, "{": 1, "]": -1, "}": -1}.get(piece, 0)
            parts += piece
        line += piece.count("\n")


def _pieces(text: str) -> Iterator[str]:
    return (piece[0] for piece in PIECE.finditer(text))


def _key_of_statement(statement: str) -> str:
    """Return the key of a statement, the text before its =."""
    key = ""
    for piece in _pieces(statement):
        if piece == "=":
            break
        key += piece
    return key


def _names_in(statement: str) -> Iterator[str]:
    """Yield the names in a header or in a dotted key, from the outside in."""
    value: Any = tomllib.loads(statement)
    while value:
        value = value[0] if isinstance(value, list) else value
        if not isinstance(value, dict) or not value:
            return
        name, value = next(iter(value.items()))
        yield name


_AT_LINE = re.compile(r"at line (\d+)")
_BARE = re.compile(r"""\s*([A-Za-z0-9_.-]+)\s*=\s*([^\s"'\[{#][^#,}\]]*)""")
_QUOTES = frozenset("“”„‘’«»")
# Characters of a value that is quoted in a message.
_MAX_QUOTED = 40


def toml_mistake(content: str, problem: str) -> str:
    """Return the reader's problem, with a hint where the mistake is a common one."""
    location = _AT_LINE.search(problem)
    lines = content.splitlines()
    line = lines[int(location[1]) - 1] if location and 0 < int(location[1]) <= len(lines) else ""
    hint = _hint(content, line, problem)
    return f"is not TOML: {problem}{hint and '; ' + hint}"


def _hint(content: str, line: str, problem: str) -> str:
    if content.startswith("\ufeff"):
        return "it begins with a byte-order mark; save it as UTF-8 without one"
    if content.lstrip().startswith("{"):
        return 'this is JSON; write lines such as: system = "pendulum"'
    foreign = next((c for c in line if c in _QUOTES), None)
    if foreign:
        return f'write " for {foreign} ({unicodedata.name(foreign).lower()})'
    if re.match(r"\s*(import|from|def|class|#include|using)\b", line):
        return 'this is a program; a scene is a file of lines such as: system = "pendulum"'
    if re.match(r"\s*[A-Za-z0-9_-]+\s*:", line):
        return "write = for :"
    if re.search(r"\d,\d", line):
        return "write a decimal with a point, as 0.5"
    if "=" not in line and "key" in problem:
        return 'every line is a key with its value, such as: system = "pendulum"'
    if re.search(r"[,;]\s*$", line) and "newline" in problem:
        return "leave out what stands after the value"
    if "overwrite" in problem:
        return "the key stands twice; leave one out"
    bare = _BARE.match(line)
    if not bare:
        return ""
    key, value = bare[1], bare[2].strip()[:_MAX_QUOTED]
    if value in ("True", "False"):
        return f"write {key} = {value.lower()}"
    return f'write a text in quotation marks: {key} = "{value}"'


_TOO_DEEP = f"is nested deeper than {MAX_DEPTH}"


def read_toml(path: Path) -> dict[str, Any]:
    """Return the file's data; InputError names the file and the problem."""
    return toml_data(read_text(path), str(path))


def toml_data(content: str, source: str) -> dict[str, Any]:
    """Return the text's data; InputError names the source and the problem."""
    if any(token["deep"] for token in PIECE.finditer(content)):
        raise InputError("file", source, _TOO_DEEP)
    try:
        data = tomllib.loads(content, parse_float=str)
    except (ValueError, RecursionError) as error:  # TOMLDecodeError is a ValueError
        raise InputError("file", source, toml_mistake(content, str(error))) from None
    check_depth(data, "file", source)
    _check_texts(data, source)
    return data


# The key by which each kind of file is known, what it is, and who reads it.
_KINDS = {
    "claim": ("a file of claims", "verify check"),
    "table": ("a file of printed tables", "verify check-table"),
    "schemes": ("a scene", "verify report"),
}


def check_kind(data: dict[str, Any], key: str, source: str) -> None:
    """Raise InputError if data without this key have that of another kind of file."""
    for other, (kind, command) in _KINDS.items():
        if key not in data and other in data:
            raise InputError("file", source, f"is {kind}; {command} takes it")


def check_depth(data: Any, name: str, source: str) -> None:
    """Raise InputError, which names the source, where data are nested too deep."""
    # Level by level, since a recursive walk of hostile data could exhaust the stack.
    level = [data]
    for _ in range(MAX_DEPTH):
        level = [x for v in level if isinstance(v, dict) for x in v.values()] + [
            x for v in level if isinstance(v, list) for x in v
        ]
    if level:
        raise InputError(name, source, _TOO_DEEP)


def _check_texts(data: Any, source: str, path: str = "") -> None:
    """Raise InputError if a key or a text holds a control character of terminals."""
    if isinstance(data, str):
        if control := CONTROL_CHARACTERS.search(data):
            instead = "write a text with a \\ in it between '…'"
            problem = f"holds U+{ord(control[0]):04X}, a control character; {instead}"
            raise InputError(f"{source}: {path}", data, problem)
    elif isinstance(data, dict):
        for key, value in data.items():
            _check_texts(key, source, "a key")
            _check_texts(value, source, f"{path}.{key}" if path else key)
    elif isinstance(data, list):
        for value in data:
            _check_texts(value, source, path)


def tables_of(file: str, key: str, tables: Any) -> list[Any]:
    """Return the tables under the key in a file of that name; InputError if they are no list."""
    if not isinstance(tables, list):
        raise InputError(f"{file}: {key}", tables, f"write [[{key}]] tables")
    return tables
