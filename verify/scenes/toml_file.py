"""A TOML text that may be anybody's, as data: its decimals stay texts, so that they are exact.

`tomllib` takes time and memory as the square of the parts of one dotted key, so that one of many
parts is refused before it reads.

Why a text is not TOML: the mistake in the line where the reader stopped.
"""

import re
import tomllib
import unicodedata
from pathlib import Path
from typing import Any

from verify.errors import CONTROL, InputError
from verify.files import read_text
from verify.scenes.toml_lines import MAX_DEPTH, PIECE

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
