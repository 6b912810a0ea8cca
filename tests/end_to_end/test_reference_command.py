"""`verify reference make` and `check`: the same bytes however made, exit statuses, JSON's keys."""

import hashlib
import json
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.end_to_end.test_command_line import apart, here, json_of
from tests.helpers.constructed.reference import SCENES
from verify.reference.make.data_folder import PUBLISHED, committed_scenes

LIMIT = 5_000_000  # bytes of the committed set


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(SCENES["mine"])
    return path


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def test_what_is_made_agrees_and_a_changed_digit_is_told_with_status_1(
    capsys: pytest.CaptureFixture[str], scene: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    status, out, _ = here(capsys, "reference", "make", str(scene), "-o", str(folder), "--json")
    assert status == 0
    shown = json_of(out)
    assert set(shown) == {"directory", "rows", "bytes", "files"}
    files = content(folder)
    assert {x["name"] for x in shown["files"]} == set(files) - {"manifest.json"}
    for each in shown["files"]:
        assert each["sha256"] == hashlib.sha256(files[each["name"]]).hexdigest()
    status, out, _ = here(capsys, "reference", "check", str(folder), "--all")
    assert (status, out.split(":")[0]) == (0, "agrees")
    path = folder / "mine-runs.csv"
    lines = path.read_text().split("\n")
    cells = lines[3].split(",")
    cells[9] = cells[9][:-5] + ("1" if cells[9][-5] != "1" else "2") + cells[9][-4:]
    path.write_text("\n".join([*lines[:3], ",".join(cells), *lines[4:]]))
    status, out, _ = here(capsys, "reference", "check", str(folder), "--share", "0")
    assert status == 1
    assert out.startswith("DIFFERS: mine-runs.csv: ")
    status, out, _ = here(capsys, "reference", "check", str(folder), "--json")
    shown = json_of(out)
    assert status == 1
    assert shown["agrees"] is False
    keys = {"agrees", "files", "rows", "recomputed", "seed", "differences", "not_recomputed"}
    assert set(shown) == keys | {"not_compared"}
    cell = next(x for x in shown["differences"] if x["column"] == "p")
    assert cell["row"] == "line 4"
    assert cell["found"] == cells[9]


def test_the_bytes_do_not_depend_on_the_workers_nor_on_what_was_kept(
    capsys: pytest.CaptureFixture[str], scene: Path, tmp_path: Path
) -> None:
    kept = tmp_path / "kept"
    ways = {
        "one": ["--workers", "1", "--keep", str(kept)],
        "two": ["--workers", "2"],
        "again": ["--keep", str(kept)],
    }
    for name, more in ways.items():
        command = ["reference", "make", str(scene), "-o", str(tmp_path / name), *more]
        status, _, err = here(capsys, *command)
        assert (status, err) == (0, "")
    assert list(kept.iterdir())
    assert content(tmp_path / "one") == content(tmp_path / "two") == content(tmp_path / "again")


@pytest.mark.left_to_ci
def test_the_committed_set_is_of_its_scenes_small_and_agrees(
    capsys: pytest.CaptureFixture[str],
) -> None:
    status, out, _ = here(capsys, "reference", "check", "--share", "0.005", "--seed", "7")
    assert (status, out.split(":")[0]) == (0, "agrees"), out
    assert sum(map(len, content(PUBLISHED).values())) < LIMIT
    manifest = json.loads((PUBLISHED / "manifest.json").read_text())
    made = {each["name"]: each["toml"] for each in manifest["scenes"]}
    assert made == {path.stem: path.read_text() for path in committed_scenes()}
    assert manifest["command"] == "verify reference make"


def test_the_committed_set_is_what_is_made_now(tmp_path: Path) -> None:
    path = next(x for x in committed_scenes() if x.stem == "extreme-escape")
    done = apart("reference", "make", str(path), "-o", str(tmp_path))
    assert done.returncode == 0, done.stderr
    for name, made in content(tmp_path).items():
        if name.startswith("extreme-escape"):
            assert (PUBLISHED / name).read_bytes() == made, name


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (["make", "nowhere.toml"], "nowhere.toml"),
        (["make", "SCENE", "SCENE"], "two scenes"),
        (["make", "NOTHING"], "asks for no [[reference]]"),
        (["check", "nowhere"], "nowhere"),
        (["check", "--share", "2"], "--share"),
        (["check", "--share", "nan"], "--share"),
        (["check", "--all", "--share", "0.1"], "--all"),
        (["check", "--seed", "-1"], "--seed"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    capsys: pytest.CaptureFixture[str], scene: Path, tmp_path: Path, given: list[str], says: str
) -> None:
    nothing = tmp_path / "nothing.toml"
    nothing.write_text('hamiltonian = "p**2"\nschemes = ["lie2"]\n')
    names = {"SCENE": str(scene), "NOTHING": str(nothing)}
    status, out, err = here(capsys, "reference", *(names.get(x, x) for x in given))
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert says in err


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("steps = [0, 1, 7, 30]", "steps = [1, 0]", "ascend"),
        ("steps = [0, 1, 7, 30]", "steps = [-1]", "steps"),
        ("steps = [0, 1, 7, 30]", "steps = []", "steps"),
        ("digits = 14", "digits = 0", "digits"),
        ("digits = 14", "digit = 14", "unknown key"),
        ('[0.1, "1/3"]', "[0.1, 0.10]", "stands twice"),
        ('[0.1, "1/3"]', "[0]", "greater than 0"),
        ('parameters = { a = "3/2" }', "", "has no value"),
        ("digits = 14", 'schemes = ["lie0"]', "lie0"),
    ],
)
def test_a_section_that_cannot_be_is_one_line(
    capsys: pytest.CaptureFixture[str], scene: Path, old: str, new: str, says: str
) -> None:
    assert old in SCENES["mine"]
    scene.write_text(SCENES["mine"].replace(old, new))
    status, _, err = here(capsys, "reference", "make", str(scene))
    assert (status, err.count("\n")) == (2, 1)
    assert says in err


@pytest.mark.parametrize("name", ["my scene", "manifest", "data.schema", "-x", "ä"])
def test_a_scene_whose_name_no_file_can_have_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str
) -> None:
    path = tmp_path / f"{name}.toml"
    path.write_text(SCENES["mine"])
    status, _, err = here(capsys, "reference", "make", str(path), "-o", str(tmp_path / "out"))
    assert (status, err.count("\n")) == (2, 1)
    assert "name=" in err


def test_a_scheme_that_is_not_computed_again_is_named(
    capsys: pytest.CaptureFixture[str], scene: Path, tmp_path: Path
) -> None:
    own = "p_next = p - h*3/2*sin(q); q_next = q + h*p_next"
    scene.write_text(SCENES["mine"].replace('"lie1"', f'"{own}"'))
    folder = str(tmp_path / "out")
    assert here(capsys, "reference", "make", str(scene), "-o", folder)[0] == 0
    status, out, _ = here(capsys, "reference", "check", folder, "--all")
    assert status == 0
    assert out.count(f"not looked at: mine.json: run no. 1: {own}") == 1


def test_other_commands_say_that_they_leave_reference_data_out(
    capsys: pytest.CaptureFixture[str], scene: Path
) -> None:
    left = json_of(here(capsys, "plan", str(scene), "--json")[1])["left_out"]
    assert any("reference data" in x["what"] and "make" in x["why"] for x in left)


def test_parquet_is_the_same_tables_or_one_line_says_what_is_missing(
    capsys: pytest.CaptureFixture[str], scene: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    command = ["reference", "make", str(scene), "-o", str(folder), "--parquet"]
    status, _, err = here(capsys, *command)
    if find_spec("pyarrow") is None:
        assert (status, err.count("\n")) == (2, 1)
        assert "pyarrow" in err
        return
    assert status == 0
    from tests.helpers.constructed.reference import repaired
    from verify.reference.make.file_contents import parquet_bytes, parquet_rows

    status, out, _ = here(capsys, "reference", "check", str(folder), "--share", "0", "--json")
    assert (status, json_of(out)["not_compared"]) == (0, [])
    path = folder / "mine-runs.parquet"
    rows = parquet_rows(path.read_bytes(), path.name)
    planted = [*rows[:4], (*rows[4][:9], "1.25e+00", *rows[4][10:]), *rows[5:]]
    path.write_bytes(parquet_bytes(planted))
    repaired(folder, path.name)
    status, out, _ = here(capsys, "reference", "check", str(folder), "--share", "0")
    assert status == 1
    assert "mine-runs.parquet: line 5: p:" in out
    path.write_bytes(b"PAR1" + b"x" * 50)
    repaired(folder, path.name)
    status, _, err = here(capsys, "reference", "check", str(folder))
    assert (status, err.count("\n")) == (2, 1)
