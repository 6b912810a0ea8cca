"""A folder of reference data that is damaged in any way is told from one that is not."""

import json
import random
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.reference import (
    IN_DEGREES,
    POLES,
    SCENES,
    changed,
    flipped,
    made,
    put,
    repaired,
)
from verify.errors import InputError
from verify.reference.check.folder_check import CheckResult, check
from verify.reference.compare.published_data import load
from verify.reference.make.data_files import MANIFEST, OF_DEGREES, Manifest, digest, json_text
from verify.reference.make.models import Data

OF_PLANE = "data.schema.json"
FLIPS = 12  # of each kind of file


@pytest.fixture(scope="module")
def data() -> list[Data]:
    return made()


@pytest.fixture
def folder(data: list[Data], tmp_path: Path) -> Path:
    put(tmp_path / "set", data)
    return tmp_path / "set"


def put_changed(folder: Path, name: str, place: list[Any], value: Any) -> None:
    """All files of the scenes, with another value there in those of one of them."""
    scenes = SCENES if name in SCENES else IN_DEGREES
    put(folder, [changed(x, place, value) if x.name == name else x for x in made(scenes)], scenes)


def look(folder: Path, share: float = 0.0, **more: Any) -> CheckResult:
    return check(folder, share=share, seed=1, **more)


def first(folder: Path) -> str:
    found = look(folder)
    return str(found.differences[0]) if found.differences else ""


@pytest.mark.parametrize(
    ("scenes", "rows", "schema"),
    [
        (SCENES, 56, OF_PLANE),
        (IN_DEGREES, 9 + 3 + 3 + 4 + 2 + 2, OF_DEGREES),
        ({"pole": POLES["pole"]}, 1 + 4, OF_PLANE),
        ({"pole": POLES["pole-in-degrees"]}, 1 + 4, OF_DEGREES),
    ],
    ids=["plane", "degrees", "pole", "pole-in-degrees"],
)
def test_what_was_made_agrees_and_is_computed_again(
    scenes: dict[str, str], rows: int, schema: str, tmp_path: Path
) -> None:
    """Also where the energy is null, as H is not defined there."""
    put(tmp_path / "set", made(scenes), scenes)
    found = look(tmp_path / "set", share=1)
    assert not found.differences
    assert not found.not_recomputed
    assert found.files == 2 + 4 * len(scenes)
    assert found.recomputed == found.rows == rows
    assert {x.name for x in tmp_path.glob("set/data*.schema.json")} == {schema}, "and no other"


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


def next_digit(cell: dict[str, str]) -> dict[str, str]:
    """The number with another last digit."""
    mantissa, _, exponent = cell["value"].partition("e")
    return cell | {"value": f"{mantissa[:-1]}{(int(mantissa[-1]) + 1) % 10}e{exponent}"}


@pytest.mark.parametrize(
    ("name", "place", "column"),
    [
        ("mine", ["runs", 3, "rows", 2, "delta_j"], "delta_j"),
        ("heiles", ["runs", 1, "rows", 2, "energy"], "energy"),
        ("heiles", ["runs", 1, "rows", 2, "q", 1], "q2"),
        ("heiles", ["flow", 0, "rows", 2, "p", 0], "p1"),
    ],
    ids=lambda x: x if isinstance(x, str) else "",
)
def test_a_number_changed_in_every_file_alike_is_found_by_computing_it(
    name: str, place: list[Any], column: str, tmp_path: Path
) -> None:
    put_changed(tmp_path / "set", name, place, next_digit)
    assert not look(tmp_path / "set").differences
    (only,) = look(tmp_path / "set", share=1).differences
    cell = json.loads((tmp_path / "set" / f"{name}.json").read_text())
    for part in place:
        cell = cell[part]
    assert (only.file, only.column, only.found) == (f"{name}.json", column, cell["value"])
    assert only.row.startswith(("lie1, h = ", "lie2, h = ", "exact flow, h = "))


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


@pytest.mark.parametrize(
    ("name", "place", "change", "says"),
    [
        ("mine", ["runs"], lambda runs: runs[:-1], ("runs no. 8: what is asked for", "is None")),
        ("heiles", ["runs", 0, "rows"], lambda rows: rows[:2], ("what is asked for", "(0, 1, 20)")),
        ("heiles", ["runs", 0, "q"], lambda _: ["0.3", "0.2"], ("what is asked for",)),
        ("heiles", ["proofs", 1, "symplectic"], lambda _: True, ("should be no order",)),
    ],
    ids=["a run left out", "rows left out", "another start", "symplectic with an order"],
)
def test_what_does_not_fit_the_scene_or_itself_is_told_though_all_files_agree(
    name: str, place: list[Any], change: Any, says: tuple[str, ...], tmp_path: Path
) -> None:
    put_changed(tmp_path / "set", name, place, change)
    assert all(x in first(tmp_path / "set") for x in says)


@pytest.mark.parametrize("letter", ["p", "q"])
@pytest.mark.parametrize("many", [1, 3])
def test_a_state_of_another_length_is_found(letter: str, many: int, tmp_path: Path) -> None:
    place = ["runs", 1, "rows", 2, letter]
    put_changed(tmp_path / "set", "heiles", place, lambda state: (state * 2)[:many])
    assert {x.column for x in look(tmp_path / "set", share=1).differences} >= {"p, q"}


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


def test_a_folder_of_both_kinds_is_checked_and_read(tmp_path: Path) -> None:
    plane = {"mine": 'hamiltonian = "p**2/2 + q**4"\nschemes = ["lie1"]\n[[reference]]\n'
             'step_sizes = [0.1]\ninitial_values = [{ q = 1, p = 0 }]\nsteps = [0, 2]\n'
             'digits = 9\nflow = false\n'}  # fmt: skip
    both = plane | {"heiles": IN_DEGREES["heiles"]}
    put(tmp_path / "set", made(both), both)
    assert not look(tmp_path / "set", share=0.2).differences
    assert [run.scene for run in load(tmp_path / "set", None).runs()] == ["mine"]
    several = load(tmp_path / "set", None, planar=False)
    assert {run.scene for run in several.runs()} == {"heiles"}
    path = tmp_path / "set" / "mine.json"
    path.write_bytes((tmp_path / "set" / "heiles.json").read_bytes())
    repaired(tmp_path / "set", "mine.json")
    assert look(tmp_path / "set").differences, "of another kind than its scene"
