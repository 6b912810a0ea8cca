"""Files are read whole and regular, and nothing else is replaced."""

import os
from pathlib import Path

import pytest

from verify.claims.claims_file import load_claims
from verify.errors import InputError
from verify.files import read_bytes, read_text, write_atomically
from verify.formats import read_json
from verify.scenes.scene import load_scene

READERS = [read_bytes, read_text, load_scene, load_claims, lambda path: read_json(path, "x 1")]


@pytest.mark.parametrize("read", READERS)
def test_what_is_no_regular_file_is_refused_at_once(read: object, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("/dev/zero")
    places = [Path("/dev/zero"), tmp_path / "pipe", tmp_path / "link", tmp_path, Path("a\0b")]
    for path in [*places, tmp_path / "none"]:
        with pytest.raises(InputError, match=r"regular file|directory|null|No such file"):
            read(path)  # type: ignore[operator]


def test_a_file_beyond_the_limit_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.toml"
    with path.open("wb") as file:
        file.truncate(50 * 2**20)
    with pytest.raises(InputError, match="has 52428800 bytes; allowed: 4194304"):
        load_scene(path)
    path.write_bytes(b"\xff")
    with pytest.raises(InputError, match="not UTF-8 text, at byte 0"):
        read_text(path)


def test_nothing_but_a_regular_file_that_may_be_written_is_replaced(tmp_path: Path) -> None:
    target = tmp_path / "target"
    target.write_text("mine")
    (tmp_path / "link").symlink_to(target)
    (tmp_path / "nowhere").symlink_to(tmp_path / "none")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "read-only").write_text("old")
    (tmp_path / "read-only").chmod(0o444)
    before = {path: os.lstat(path) for path in tmp_path.iterdir()}
    for path in [*sorted(set(before) - {target}), Path("/dev/null"), tmp_path]:
        with pytest.raises(InputError, match=r"link|regular file|read-only|folder"):
            write_atomically(path, "new")
    assert {path: os.lstat(path) for path in tmp_path.iterdir()} == before
    assert (target.read_text(), (tmp_path / "read-only").read_text()) == ("mine", "old")
    write_atomically(target, "new")
    assert target.read_text() == "new"


@pytest.mark.parametrize(
    "text",
    [
        'title = "a\\u001b[31mb"\nhamiltonian = "p**2/2"\nschemes = ["lie1"]',
        '"a\\u009bb" = 1',
        'schemes = ["a\\u202eb"]',
    ],
)
def test_a_control_character_in_a_scene_or_claims_file_is_refused(
    text: str, tmp_path: Path
) -> None:
    path = tmp_path / "x.toml"
    path.write_text(text)
    for load in (load_scene, load_claims):
        with pytest.raises(InputError, match=r"holds U\+(001B|009B|202E), a control") as error:
            load(path)
        assert str(error.value).isprintable()
