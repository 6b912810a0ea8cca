"""The keys of `results.json`, from the JSON Schema of the model that writes it."""

import inspect
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from docs._generate.markdown import code, prose, table
from verify.scenes.results.report import Report

FILE = Path(__file__).parents[2] / "_build" / "results.schema.json"  # git-ignored
_PLAIN = {"string": "text", "integer": "whole number", "number": "number", "null": "null",
          "boolean": "true or false"}  # fmt: skip


def schema() -> dict[str, Any]:
    """The JSON Schema (2020-12) of a report."""
    dialect = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return dialect | Report.model_json_schema(mode="serialization")


def write() -> None:
    """The schema as a file, for readers to take along."""
    FILE.parent.mkdir(exist_ok=True)
    FILE.write_text(json.dumps(schema(), ensure_ascii=False, indent=1) + "\n", encoding="utf-8")


def text() -> str:
    """A link to the whole, and a section for the report and for each kind of object in it."""
    found = schema()
    parts = {"Report": found} | found["$defs"]
    link = f"The whole as a file: [{FILE.name}](path:../{FILE.parent.name}/{FILE.name}).\n\n"
    return (
        link + "\n\n".join("\n\n".join(_section(name, part)) for name, part in parts.items()) + "\n"
    )


def _section(name: str, part: Mapping[str, Any]) -> Iterator[str]:
    yield f"### {name}"
    for paragraph in inspect.cleandoc(part.get("description", "")).split("\n\n"):
        yield f"```text\n{paragraph}\n```" if paragraph.startswith("    ") else prose(paragraph)
    if "enum" in part:
        yield f"One of {', '.join(map(code, part['enum']))}."
    else:
        yield table(("key", "is"), _rows(part))


def _rows(part: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for key, value in part.get("properties", {}).items():
        yield code(key), _words(value)


def _words(value: Mapping[str, Any]) -> str:
    if "$ref" in value:
        name = value["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "anyOf" in value:
        return " or ".join(map(_words, value["anyOf"]))
    if "const" in value or "enum" in value:
        return " or ".join(code(x) for x in value.get("enum", [value.get("const")]))
    if value.get("type") == "array":
        if "prefixItems" in value:
            return f"[{', '.join(map(_words, value['prefixItems']))}]"
        return f"array of {_words(value['items'])}" if "items" in value else "array"
    if value.get("type") == "object":
        inner = value.get("additionalProperties")
        return f"object of {_words(inner)}" if isinstance(inner, dict) else "object"
    return _PLAIN[value["type"]]
