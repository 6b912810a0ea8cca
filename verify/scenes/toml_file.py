"""A TOML text that may be anybody's, as data: its decimals stay texts, so that they are exact.

`tomllib` takes time and memory as the square of the parts of one dotted key, so that one of many
parts is refused before it reads.
"""

import tomllib
from pathlib import Path
from typing import Any

from verify.errors import CONTROL, InputError
from verify.files import read_text
from verify.scenes.mistakes.syntax import toml_mistake
from verify.scenes.toml_lines import MAX_DEPTH, PIECE

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
