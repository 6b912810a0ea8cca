"""Writing of data as TOML, from which exactly the same data are read."""

import json
from collections.abc import Collection, Mapping
from typing import Any


def toml_lines(data: Mapping[str, Any], *, inline: Collection[str] = ()) -> list[str]:
    """Return the lines of a file with these data: plain keys, then a table for each mapping.

    `inline`: the keys of mappings that stay in a line.
    """
    tables = {k: v for k, v in data.items() if k not in inline and _is_table(v)}
    # TOML requires plain keys before the first table.
    lines = [f"{name} = {_value(x)}" for name, x in data.items() if name not in tables]
    for name, x in tables.items():
        for table in x if isinstance(x, list) else [x]:
            lines += ["", f"[[{name}]]" if isinstance(x, list) else f"[{name}]"]
            lines += [f"{key} = {_value(y)}" for key, y in table.items() if y is not None]
    return lines


def _is_table(value: Any) -> bool:
    """Return True if the value is a table, or a list of tables."""
    first = value[0] if isinstance(value, list) and value else value
    return isinstance(first, Mapping)


def _value(x: Any) -> str:
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, Mapping):
        inside = ", ".join(f"{json.dumps(k)} = {_value(y)}" for k, y in x.items() if y is not None)
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(x, list):
        return f"[{', '.join(map(_value, x))}]"
    if isinstance(x, int):
        return str(x)
    # TOML's basic strings escape as JSON's do, but for DEL, which JSON leaves as it is.
    return json.dumps(str(x), ensure_ascii=False).replace("\x7f", "\\u007F")
