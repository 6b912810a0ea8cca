"""The published schemas are current, describe every key, and hold for the committed set and
for what is made anew."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.reference import IN_DEGREES, SCENES, made, put
from verify.content import content
from verify.reference.make.data_files import MANIFEST, OF_DEGREES, SCHEMAS, schema_text
from verify.reference.make.data_folder import PUBLISHED

FOLDER = content("reference")
every_schema = pytest.mark.parametrize("name", SCHEMAS)


def keys_of(schema: Any, where: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    if isinstance(schema, dict):
        for name, key in schema.get("properties", {}).items():
            yield f"{where}.{name}", key
        for name, part in schema.items():
            yield from keys_of(part, f"{where}.{name}")
    elif isinstance(schema, list):
        for part in schema:
            yield from keys_of(part, where)


@every_schema
def test_the_published_file_is_what_the_models_say(name: str) -> None:
    assert (FOLDER / name).read_text(encoding="utf-8") == schema_text(name)
    assert (PUBLISHED / name).read_text(encoding="utf-8") == schema_text(name)


@every_schema
def test_every_key_is_described_and_no_other_is_allowed(name: str) -> None:
    schema = json.loads(schema_text(name))
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    keys = dict(keys_of(schema))
    assert len(keys) > 8
    assert [where for where, key in keys.items() if not key.get("description")] == []
    for part in (schema, *schema["$defs"].values()):
        assert part["type"] != "object" or part["additionalProperties"] is False


@pytest.mark.parametrize(
    ("name", "scenes"),
    [("data.schema.json", SCENES), (OF_DEGREES, IN_DEGREES)],
    ids=["plane", "degrees"],
)
def test_it_holds_for_what_is_made(name: str, scenes: dict[str, str], tmp_path: Path) -> None:
    validator = validator_of(name)
    put(tmp_path / "set", made(scenes), scenes)
    for scene in scenes:
        data = json.loads((tmp_path / "set" / f"{scene}.json").read_text())
        validator.validate(data)
        assert not validator.is_valid(data | {"planted": 1})


def validator_of(name: str) -> Any:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(schema_text(name))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def of_schema(path: Path, name: str) -> bool:
    """Whether a committed file is of this schema: the manifest, of the plane, of n degrees."""
    if path.name in SCHEMAS or (path.name == MANIFEST) != (name[0] == "m"):
        return False
    return name[0] == "m" or path.name.startswith("several-") == (name == OF_DEGREES)


@pytest.mark.left_to_ci
@every_schema
def test_it_is_a_schema_and_the_committed_files_are_of_it(name: str) -> None:
    validator = validator_of(name)
    wanted = [path for path in sorted(PUBLISHED.glob("*.json")) if of_schema(path, name)]
    assert wanted
    for path in wanted:
        content = json.loads(path.read_text(encoding="utf-8"))
        validator.validate(content)
        content["planted"] = 1
        assert not validator.is_valid(content)
