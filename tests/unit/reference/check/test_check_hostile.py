"""Forged data whose every hash is right: found, in little time and memory, and told in one line."""

import errno
import io
import json
from datetime import date
from decimal import Decimal
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.constructed.reference import changed, made, put, repaired
from verify.errors import InputError
from verify.files import write_atomically
from verify.reference.check.folder_check import CheckResult, check
from verify.reference.check.recomputation import recompute_unit
from verify.reference.compare.published_data import load as published
from verify.reference.make.data_files import MANIFEST
from verify.reference.make.data_folder import check_is_alone, load
from verify.reference.make.models import Data

SCENES = {
    "mine": """
hamiltonian = "p**2/2 + q**2/2 - a*q**3/3"
parameters = { a = 1 }
schemes = ["lie2"]
[[reference]]
step_sizes = ["1/8"]
initial_values = [{ q = 0, p = 2 }]
steps = [0, 1, 24]
digits = 9
"""
}
NUMBER = ["runs", 0, "rows", 1, "q"]


@pytest.fixture(scope="module")
def data() -> Data:
    return made(SCENES)[0]


@pytest.fixture
def folder(data: Data, tmp_path: Path) -> Path:
    put(tmp_path / "set", [data], SCENES)
    return tmp_path / "set"


def look(folder: Path, **more: Any) -> CheckResult:
    return check(folder, **({"share": 0.0, "seed": 1} | more))


def test_without_a_forgery_all_agrees(folder: Path) -> None:
    found = look(folder, share=1.0)
    assert (found.differences, found.not_recomputed) == ([], [])


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        ([*NUMBER, "value"], "1e+999999999", "9 digits"),
        ([*NUMBER, "value"], "1e-999999999999", "a digit that is not 0"),
        ([*NUMBER, "value"], f"1.{'1' * 5000}e+00", "9 digits"),
        ([*NUMBER, "radius"], "5e+999999999", "q_radius"),
        (["runs", 0, "q"], "1/0", "asked for"),
        (["runs", 0, "q"], "9" * 5000, "asked for"),
        (["runs", 0, "digits"], 10**9, "asked for"),
        (["parameters", "a"], "1/0", "asked for"),
    ],
)
def test_a_number_that_cannot_be_held_is_a_difference(
    folder: Path, data: Data, place: list[Any], value: Any, says: str
) -> None:
    put(folder, [changed(data, place, value)], SCENES)
    differences = [str(x) for x in look(folder).differences]
    assert any(says in x for x in differences), differences
    assert max(map(len, differences)) < 500


def test_a_value_beyond_all_rationals_is_compared(data: Data) -> None:
    forged = changed(data, NUMBER, {"value": "1.23456789e+999999999", "radius": "5e+999999990"})
    assert [x.column for x in recompute_unit(forged, "file", "run", 0).differences] == ["q"]


@pytest.mark.parametrize(
    ("old", "new"), [(b"\n", b"\r\n"), (b"lie2", b'"lie2"'), (b"\n", b"")], ids=repr
)
def test_a_table_that_is_written_in_another_way_is_a_difference(
    folder: Path, old: bytes, new: bytes
) -> None:
    path = folder / "mine-proofs.csv"
    content = path.read_bytes()
    last = content.rfind(old)
    path.write_bytes(content[:last] + new + content[last + len(old) :])
    repaired(folder, path.name)
    assert [x.file for x in look(folder).differences] == [path.name]


def test_very_many_wrong_lines_are_one_difference(folder: Path) -> None:
    (folder / "mine-runs.csv").write_bytes(b"\n" * 100_000)
    repaired(folder, "mine-runs.csv")
    assert len(look(folder).differences) == 1


def test_half_a_character_is_one_line(folder: Path) -> None:
    path = folder / MANIFEST
    path.write_text(path.read_text().replace("hamiltonian", "\\ud800", 1))
    with pytest.raises(InputError, match="half a character"):
        look(folder)


def test_a_name_cannot_command_a_terminal(folder: Path) -> None:
    (folder / "a\x1b[31m").touch()
    (only,) = look(folder).differences
    assert "\x1b" not in str(only)


def test_files_that_fill_the_memory_together_are_not_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("verify.reference.check.folder_check._MOST_BYTES_OF_ALL", 1000)
    with pytest.raises(InputError, match="more than 1000 bytes"):
        look(folder)


def test_a_full_disk_names_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match=r"No space left on device.*mine\.json"):
        write_atomically(tmp_path / "mine.json", "text")
    assert not list(tmp_path.iterdir())


# -- scenes and commands --------------------------------------------------------------------------


def test_the_command_names_the_scenes_files(folder: Path) -> None:
    path = folder / MANIFEST
    path.write_text(path.read_text().replace("make mine.toml", "make yours.toml"))
    (only,) = look(folder).differences
    assert (only.column or only.row, only.wanted) == ("command", "mine.toml")


def test_a_scene_that_asks_for_too_much_is_neither_made_nor_checked(
    folder: Path, tmp_path: Path
) -> None:
    many = ", ".join(map(str, range(1000)))
    toml = SCENES["mine"].replace("0, 1, 24", many).replace("digits = 9", "digits = 1000")
    toml = toml.replace('"1/8"', ", ".join(f"1/{k}".join('""') for k in range(1, 21)))
    (tmp_path / "mine.toml").write_text(toml)
    with pytest.raises(InputError, match="allowed: 67108864"):
        load([tmp_path / "mine.toml"])
    path = folder / MANIFEST
    path.write_text(path.read_text().replace(json.dumps(SCENES["mine"]), json.dumps(toml)))
    assert any("data can be read" in str(x) for x in look(folder).differences)


def test_a_sample_does_no_more_steps_than_it_may_and_says_so(folder: Path) -> None:
    assert not look(folder, share=1.0, most_steps=24).not_recomputed
    (told,) = look(folder, share=1.0, most_steps=23).not_recomputed
    assert "more than 23 steps" in told


def test_a_folder_with_other_files_is_refused(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(SCENES["mine"])
    asked = load([tmp_path / "mine.toml"])
    check_is_alone(folder, asked, parquet=False)
    (folder / "mine-runs.parquet").touch()
    check_is_alone(folder, asked, parquet=True)
    with pytest.raises(InputError, match=r"mine-runs\.parquet"):
        check_is_alone(folder, asked, parquet=False)


# -- the exact flow at a burst --------------------------------------------------------------------


@pytest.mark.parametrize(("row", "q", "found"), [(2, "1.20000000e+00", "p, q"), (1, None, "p")])
def test_rows_of_a_solution_that_blows_up_are_looked_at(
    data: Data, row: int, q: str | None, found: str
) -> None:
    assert [x.status for x in data.flow[0].rows] == ["finished", "finished", "blows up"]
    good = data.flow[0].rows[1].model_dump(mode="json")
    planted = good | {"step": data.flow[0].rows[row].step}
    if q:  # where there is no solution any more: any p and q, on another level of H
        planted["q"] = {"value": q, "radius": "5e-09"}
    else:
        planted["p"] = good["p"] | {"value": good["p"]["value"][:-5] + "1e+00"}
    forged = changed(data, ["flow", 0, "rows", row], planted)
    differences = recompute_unit(forged, "file", "flow", 0).differences
    assert [x.column for x in differences] == [found]


def test_an_early_burst_is_a_difference(data: Data) -> None:
    nothing = data.flow[0].rows[2].model_dump(mode="json") | {"step": 1}
    (only,) = recompute_unit(
        changed(data, ["flow", 0, "rows", 1], nothing), "file", "flow", 0
    ).differences
    assert (only.column, only.wanted) == ("status", "finished")


# -- Parquet --------------------------------------------------------------------------------------


@pytest.mark.skipif(find_spec("pyarrow") is None, reason="pyarrow is not installed")
@pytest.mark.parametrize(
    ("names", "columns", "says"),
    [
        (["a"], [[""] * 9_000_000], "too many cells"),
        (["a"], [["x" * 2_000_000] * 50], "too long cells"),
        (["a", "a"], [["1"], ["2"]], "stands twice"),
        (["a"], [[1, 2]], "no text"),
        (["a"], [[b"1"]], "no text"),
        (["a"], [[Decimal(1)]], "no text"),
        (["a"], [[True]], "no text"),
        (["a"], [[date(2026, 1, 1)]], "no text"),
        (["a"], [[{"b": "1"}]], "no text"),
        (["a"], [[["1"]]], "no text"),
    ],
)
def test_a_table_that_would_fill_the_memory_is_one_line(
    names: list[str], columns: list[list[Any]], says: str
) -> None:
    import pyarrow
    from pyarrow import parquet

    from verify.reference.make.file_contents import parquet_bytes, parquet_rows

    rows = [("a", "b"), ("1", ""), ("2", "x")]
    assert parquet_rows(parquet_bytes(rows), "mine.parquet") == rows
    out = io.BytesIO()
    table = pyarrow.table([pyarrow.array(x) for x in columns], names=names)
    parquet.write_table(table, out, compression="zstd", store_schema=False)
    with pytest.raises(InputError, match=f"mine.parquet.*{says}"):
        parquet_rows(out.getvalue(), "mine.parquet")


IN_TIME = """
hamiltonian = "p**2/2 + q**2/2 + q*cos(t)"
schemes = ["lie1", "lie2"]
[[reference]]
step_sizes = [0.1]
initial_values = [{ q = 1, p = 0 }]
steps = [0, 1]
digits = 9
flow = false
"""


def test_a_run_without_a_time_among_those_that_have_one_differs(tmp_path: Path) -> None:
    scenes = {"driven": IN_TIME}
    (data,) = made(scenes)
    raw = data.model_dump(mode="json", by_alias=True)
    del raw["runs"][0]["t0"]
    put(tmp_path / "set", [Data.model_validate(raw)], scenes)
    assert check(tmp_path / "set", share=1, seed=1).differences
    with pytest.raises(InputError, match="H depends on t, and its runs have no t0"):
        published(tmp_path / "set", None)
