"""A folder of reference data that is damaged in any way is told from one that is not."""

import json
import random
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.reference import SCENES, changed, flipped, made, put, repaired
from verify.errors import InputError
from verify.reference.check.check import CheckResult, check
from verify.reference.make.models import DATA_FORMAT, Data, Manifest
from verify.reference.make.writing import MANIFEST, digest, json_text

FLIPS = 12  # of each kind of file


@pytest.fixture(scope="module")
def data() -> list[Data]:
    return made()


@pytest.fixture
def folder(data: list[Data], tmp_path: Path) -> Path:
    put(tmp_path / "set", data)
    return tmp_path / "set"


def look(folder: Path, share: float = 0.0, **more: Any) -> CheckResult:
    return check(folder, share=share, seed=1, **more)


def first(folder: Path) -> str:
    found = look(folder)
    return str(found.differences[0]) if found.differences else ""


def test_what_was_made_agrees(folder: Path) -> None:
    found = look(folder, share=1)
    assert not found.differences
    assert not found.not_recomputed
    assert found.files == 10
    assert found.recomputed == found.rows > 30


def test_a_share_is_a_sample_and_the_seed_says_which(folder: Path) -> None:
    some = check(folder, share=0.2, seed=5)
    assert 0 < some.recomputed < look(folder, share=1).recomputed
    assert check(folder, share=0.2, seed=5).recomputed == some.recomputed


# -- any character, anywhere ----------------------------------------------------------------------


def found_in(folder: Path) -> bool:
    """Whether anything is found, be it that a file cannot be read."""
    try:
        return bool(look(folder, share=1).differences)
    except InputError:
        return True


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", [
    "mine.json", "mine-runs.csv", "mine-flow.csv", "mine-proofs.csv", "leaves.json",
    "leaves-runs.csv", "data.schema.json", "manifest.schema.json",
])  # fmt: skip
def test_a_flipped_character_is_found_though_the_manifest_is_repaired(
    folder: Path, name: str
) -> None:
    draw, path = random.Random(name), folder / name  # noqa: S311 - no secret
    text = path.read_text()
    for at in draw.sample(range(len(text)), FLIPS):
        path.write_text(flipped(text, at, draw))
        repaired(folder, name)
        assert found_in(folder), f"{text[max(0, at - 30) : at + 30]!r} at its middle"
    path.write_text(text)
    repaired(folder, name)
    assert not found_in(folder)


def test_a_flipped_character_of_the_manifest_is_found(folder: Path) -> None:
    draw, path = random.Random(3), folder / MANIFEST  # noqa: S311 - no secret
    text = path.read_text()
    told = text.index('"command"'), text.index('"scenes"')  # what nothing else here says
    places = [k for k in range(len(text)) if not told[0] <= k < told[1]]
    for at in draw.sample(places, 3 * FLIPS):
        path.write_text(flipped(text, at, draw))
        assert found_in(folder), f"{text[max(0, at - 30) : at + 30]!r} at its middle"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"command": "verify reference make', '"command": "verify reference mako'),
        ('"Python": "', '"Pytxon": "'),
        ('"sympy": "', '"sympy": "one'),
    ],
)
def test_a_command_or_version_that_can_be_none_is_found(folder: Path, old: str, new: str) -> None:
    path = folder / MANIFEST
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    assert first(folder).startswith(MANIFEST)


def test_a_number_changed_in_every_file_alike_is_found_by_computing_it(
    folder: Path, data: list[Data]
) -> None:
    cell = data[0].runs[3].rows[2].delta_j
    assert cell is not None
    value = cell.value
    wrong = value[:-5] + str((int(value[-5]) + 1) % 10) + value[-4:]
    place = ["runs", 3, "rows", 2, "delta_j", "value"]
    put(folder, [changed(data[0], place, wrong), data[1]])
    assert not look(folder).differences
    (only,) = look(folder, share=1).differences
    assert (only.file, only.column, only.found) == ("mine.json", "delta_j", wrong)
    assert "lie1" in only.row or "lie2" in only.row


# -- what must be so without computing ------------------------------------------------------------


@pytest.mark.left_to_ci
@pytest.mark.sample(15)
@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        (["runs", 0, "rows", 1, "q", "radius"], "6e-15", "q_radius"),
        (["runs", 0, "rows", 1, "q", "radius"], "0", "at most 14 digits"),
        (["runs", 0, "rows", 1, "q", "value"], "1.5e+00", "14 digits"),
        (["runs", 0, "rows", 0, "q", "value"], "1.6e+00", "1.5"),
        (["runs", 0, "rows", 0, "q", "value"], "1.50e+00", "no 0 at the end"),
        (["runs", 0, "rows", 0, "q", "value"], "0.15e+01", "a digit that is not 0"),
        (["runs", 0, "rows", 1, "mse"], None, "a number"),
        (["runs", 0, "rows", 0, "mse"], {"value": "0", "radius": "0"}, "null"),
        (["runs", 0, "rows", 1, "kind"], None, "enclosed or estimated"),
        (["runs", 0, "rows", 1, "step"], 2, "what is asked for"),
        (["runs", 0, "rows", 1, "status"], "unresolved", "null"),
        (["runs", 0, "rows", 1, "failed_step"], 1, "failed_step"),
        (["runs", 0, "scheme"], "lie2", "what is asked for"),
        (["runs", 0, "digits"], 15, "what is asked for"),
        (["flow", 0, "rows", 1, "time"], "0.2", "what is asked for"),
        (["flow", 0, "rows", 1, "p", "radius"], "5e-14", "p_radius"),
        (["hamiltonian"], "p**2/2 + a*cos(q)", "what is asked for"),
        (["parameters", "a"], "2.5", "what is asked for"),
        (["proofs", 1, "leading"], "p**", "a formula"),
        (["proofs", 1, "order"], None, "a number"),
        (["proofs", 3, "order"], 2, "no order"),
    ],
)
def test_what_contradicts_itself_is_told(
    folder: Path, data: list[Data], place: list[Any], value: Any, says: str
) -> None:
    put(folder, [changed(data[0], place, value), data[1]])
    differences = [str(x) for x in look(folder).differences]
    assert any(says in x for x in differences), differences


def test_rows_that_are_left_out_in_every_file_are_missed(folder: Path, data: list[Data]) -> None:
    runs = data[0].runs
    put(folder, [data[0].model_copy(update={"runs": runs[:-1]}), data[1]])
    assert "runs no. 8: what is asked for" in first(folder)
    assert "is None" in first(folder)


def test_missing_and_extra_files_are_named(folder: Path) -> None:
    (folder / "mine-flow.csv").rename(folder / "mine-flaw.csv")
    found = [str(x) for x in look(folder).differences]
    assert "mine-flaw.csv: should be in the manifest, or not there, is extra" in found
    assert "mine-flow.csv: should be a file, is missing" in found


def test_a_file_and_its_line_in_the_manifest_that_go_together_are_missed(folder: Path) -> None:
    path = folder / MANIFEST
    lines = [x for x in path.read_text().split("\n") if '"mine-flow.csv"' not in x]
    path.write_text("\n".join(lines))
    (folder / "mine-flow.csv").unlink()
    assert "mine-flow.csv: should be listed, is not listed" in first(folder)


@pytest.mark.parametrize("name", ["notes.txt", "other.json", "mine-flaw.csv", "mine.parquet"])
def test_a_file_of_no_scene_is_told_though_the_manifest_lists_it(folder: Path, name: str) -> None:
    """As it would be read with the others, and stand there for as good as they are."""
    source = "mine.json" if name.endswith(".json") else "mine-flow.csv"
    shutil.copy(folder / source, folder / name)
    path = folder / MANIFEST
    data, content = json.loads(path.read_text()), (folder / name).read_bytes()
    own = {"name": name, "bytes": len(content), "sha256": digest(content)}
    data["files"] = sorted([*data["files"], own], key=lambda x: x["name"])
    path.write_text(json_text(Manifest.model_validate(data)))
    assert f"{name}: should be not listed, is listed" in first(folder)


def test_hash_and_size_are_those_of_the_file(folder: Path) -> None:
    path = folder / "mine-runs.csv"
    path.write_text(path.read_text() + "\n")
    columns = {x.column for x in look(folder).differences}
    assert {"bytes", "sha256"} <= columns


def test_a_scene_that_is_not_the_one_that_is_known_is_told(folder: Path, tmp_path: Path) -> None:
    own = tmp_path / "scenes"
    own.mkdir()
    for name, toml in SCENES.items():
        (own / f"{name}.toml").write_text(toml)
    assert not look(folder, scenes_folder=own).differences
    (own / "mine.toml").write_text(SCENES["mine"].replace("A pendulum", "A pendulom"))
    assert "scene mine" in str(look(folder, scenes_folder=own).differences[0])


# -- what cannot be read --------------------------------------------------------------------------

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
