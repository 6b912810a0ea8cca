"""Files of reference data that cannot be read are named in one line, and cost no time or memory."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.reference import SCENES, made, put, repaired
from tests.unit.reference.check.test_check import first, look
from verify.errors import InputError
from verify.reference.make.data_files import MANIFEST, digest
from verify.reference.make.models import DATA_FORMAT


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    put(tmp_path / "set", made())
    return tmp_path / "set"


DEEP = b"[" * 200_000
HOSTILE = {
    "truncated": lambda x: x[: len(x) // 2],
    "empty": lambda x: b"",
    "deep": lambda x: DEEP,
    "deep objects": lambda x: b'{"a":' * 100_000,
    "not UTF-8": lambda x: x[:50] + b"\xff\xfe" + x[50:],
    "UTF-16": lambda x: x.decode().encode("utf-16"),
    "a NUL": lambda x: x[:50] + b"\0" + x[50:],
    "a key twice": lambda x: x.replace(b'{\n "format"', b'{\n "format": 1,\n "format"', 1),
    "NaN": lambda x: b'{"format": NaN}',
    "a float": lambda x: b'{"format": 1e999}',
    "a huge number": lambda x: b'{"format": ' + b"9" * 50_000 + b"}",
    "very many parts": lambda x: b"[" + b"[]," * 3_000_000 + b"[]]",
}


@pytest.mark.parametrize("name", [MANIFEST, "mine.json"])
@pytest.mark.parametrize("how", HOSTILE)
def test_json_that_cannot_be_read_is_one_line(folder: Path, name: str, how: str) -> None:
    path = folder / name
    path.write_bytes(HOSTILE[how](path.read_bytes()))
    if name != MANIFEST:
        repaired(folder, name)
    with pytest.raises(InputError) as error:
        look(folder)
    assert name in str(error.value)
    assert len(str(error.value)) < 400
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("content", [
    b'a,"b\nc', b'"a"b,c\n', b"\xff\xfe", b"a," * 9_000_000, b"x" * 200_000,
], ids=["no end", "a quote inside", "not UTF-8", "many cells", "a long cell"])  # fmt: skip
def test_csv_that_cannot_be_read_is_one_line(folder: Path, content: bytes) -> None:
    (folder / "mine-runs.csv").write_bytes(content)
    repaired(folder, "mine-runs.csv")
    with pytest.raises(InputError, match=r"mine-runs\.csv"):
        look(folder)


def test_a_huge_file_is_not_read(folder: Path) -> None:
    with (folder / "mine.json").open("r+b") as file:
        file.truncate(10**12)  # a file of holes: it takes no room on the disk
    with pytest.raises(InputError, match="1000000000000 bytes"):
        look(folder)


@pytest.mark.parametrize("value", [[], 3, "text", {"format": 1}, None])
def test_json_of_another_format_is_one_line(folder: Path, value: Any) -> None:
    (folder / "mine.json").write_text(json.dumps(value))
    repaired(folder, "mine.json")
    with pytest.raises(InputError, match=r"mine\.json.*this version reads"):
        look(folder)


@pytest.mark.parametrize("value", [{}, {"name": []}])
def test_json_of_another_shape_is_a_difference(folder: Path, value: Any) -> None:
    (folder / "mine.json").write_text(json.dumps({"format": DATA_FORMAT} | value))
    repaired(folder, "mine.json")
    assert "mine.json" in first(folder)
    assert "as the schema says" in first(folder)


def test_a_listed_name_leads_nowhere_else(folder: Path) -> None:
    path = folder / MANIFEST
    path.write_text(path.read_text().replace('"mine.json"', '"../mine.json"', 1))
    assert "as the schema says" in first(folder)


def test_a_hostile_scene_in_the_manifest_is_not_computed(folder: Path) -> None:
    toml = SCENES["mine"].replace("a*cos(q)", "__import__('os').getcwd()")
    path, manifest = folder / MANIFEST, json.loads((folder / MANIFEST).read_text())
    manifest["scenes"][0] |= {"toml": toml, "sha256": digest(toml.encode())}
    path.write_text(json.dumps(manifest))
    assert any("toml" in str(x) for x in look(folder).differences)


def test_a_folder_that_is_none_and_a_manifest_that_is_not_there(folder: Path) -> None:
    with pytest.raises(InputError, match="is no folder"):
        look(folder / "nowhere")
    (folder / MANIFEST).unlink()
    with pytest.raises(InputError, match=MANIFEST):
        look(folder)
    (folder / MANIFEST).mkdir()
    with pytest.raises(InputError, match=MANIFEST):
        look(folder)
    shutil.rmtree(folder / MANIFEST)
