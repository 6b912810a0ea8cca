"""A TOML text that may be anybody's, as data: its decimals stay texts, so that they are exact.

`tomllib` takes time and memory as the square of the parts of one dotted key, so that one of many
parts is refused before it reads.

Why a text is not TOML: the mistake in the line where the reader stopped.

On which lines of a TOML text its tables and keys stand, which `tomllib` does not tell.

The text must have been read by `tomllib`: here it is only cut into statements, so that a bracket or
a `#` in a string, and a value over several lines, mislead nobody.
"""

import re
import tomllib
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from verify.errors import CONTROL, InputError
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


_AT_LINE = re.compile(r"at line (\d+)")
_BARE = re.compile(r"""\s*([A-Za-z0-9_.-]+)\s*=\s*([^\s"'\[{#][^#,}\]]*)""")
_QUOTES = frozenset("“”„‘’«»")
_LONGEST = 40  # characters of what is quoted


def toml_mistake(content: str, problem: str) -> str:
    """The reader's problem, and what to write where the mistake is a known one."""
    found = _AT_LINE.search(problem)
    lines = content.splitlines()
    line = lines[int(found[1]) - 1] if found and 0 < int(found[1]) <= len(lines) else ""
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
    key, value = bare[1], bare[2].strip()[:_LONGEST]
    if value in ("True", "False"):
        return f"write {key} = {value.lower()}"
    return f'write a text in quotation marks: {key} = "{value}"'


_DEEPER = f"is nested deeper than {MAX_DEPTH}"


def read_toml(path: Path) -> dict[str, Any]:
    """The file's data. InputError names the file, and what is wrong."""
    return toml_data(read_text(path), str(path))


def toml_data(content: str, source: str) -> dict[str, Any]:
    """The text's data. InputError names the source, and what is wrong."""
    if any(token["deep"] for token in PIECE.finditer(content)):
        raise InputError("file", source, _DEEPER)
    try:
        data = tomllib.loads(content, parse_float=str)
    except (ValueError, RecursionError) as error:  # TOMLDecodeError is a ValueError
        raise InputError("file", source, toml_mistake(content, str(error))) from None
    check_depth(data, "file", source)
    _check_texts(data, source)
    return data


def check_depth(data: Any, name: str, source: str) -> None:
    """InputError, of a source that is called so, where data are nested too deep."""
    level = [data]
    for _ in range(MAX_DEPTH):
        level = [x for v in level if isinstance(v, dict) for x in v.values()] + [
            x for v in level if isinstance(v, list) for x in v
        ]
    if level:
        raise InputError(name, source, _DEEPER)


def _check_texts(data: Any, source: str, where: str = "") -> None:
    """InputError where a key or a text holds a character that a terminal would act on."""
    if isinstance(data, str):
        if found := CONTROL.search(data):
            instead = "write a text with a \\ in it between '…'"
            problem = f"holds U+{ord(found[0]):04X}, a control character; {instead}"
            raise InputError(f"{source}: {where}", data, problem)
    elif isinstance(data, dict):
        for key, value in data.items():
            _check_texts(key, source, "a key")
            _check_texts(value, source, f"{where}.{key}" if where else key)
    elif isinstance(data, list):
        for value in data:
            _check_texts(value, source, where)


def tables_of(file: str, key: str, given: Any) -> list[Any]:
    """The tables that stand under the key in a file of that name; InputError where none do."""
    if not isinstance(given, list):
        raise InputError(f"{file}: {key}", given, f"write [[{key}]] tables")
    return given
