"""A scene as a TOML text, from which `verify.scenes.scene` reads exactly the same scene."""

import json
from collections.abc import Mapping
from typing import Any

from verify.errors import without_controls
from verify.scenes.scene import Scene


def scene_text(scene: Scene, *, comment: str = "") -> str:
    """Return the scene's TOML without defaults, below the lines of a comment."""
    data = scene.model_dump(mode="json", exclude_defaults=True)
    lines = [f"# {without_controls(line)}".rstrip() for line in comment.splitlines()]
    tables = {k: v for k, v in data.items() if _is_table(k, v)}
    # TOML requires plain keys before the first table.
    lines += [f"{name} = {_value(x)}" for name, x in data.items() if name not in tables]
    for name, x in tables.items():
        for table in x if isinstance(x, list) else [x]:
            lines += ["", f"[[{name}]]" if isinstance(x, list) else f"[{name}]"]
            lines += [f"{key} = {_value(y)}" for key, y in table.items() if y is not None]
    return "\n".join(lines) + "\n"


def _is_table(name: str, value: Any) -> bool:
    """Return True if the value is a section of its own, not the mapping of parameters."""
    is_mapping = isinstance(value, Mapping) and name != "parameters"
    return is_mapping or (isinstance(value, list) and bool(value) and isinstance(value[0], Mapping))


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
