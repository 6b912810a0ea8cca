"""What is kept of compiled code is loaded again, and nothing else is."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from verify import code_cache
from verify.code_cache import OFF, VARIABLE, folder, keep, key_of, load
from verify.errors import InputError

KEY, OTHER = key_of("one", "2"), key_of("on", "e2")
CODE = bytes(range(256)) * 3


@pytest.fixture
def kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of what is kept, which is made when something is."""
    monkeypatch.setenv(VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache" / "kernels"


def entry(kernels: Path, key: str = KEY) -> Path:
    return kernels / f"{key}.kernel"


def test_what_is_kept_is_loaded_and_nothing_under_another_key(kernels: Path) -> None:
    assert load(KEY) is None
    keep(KEY, CODE)
    assert load(KEY) == CODE
    assert load(OTHER) is None
    keep(KEY, b"new")
    assert load(KEY) == b"new"


def test_there_is_a_key_of_any_text() -> None:
    assert len({key_of("\udcff"), key_of("\xff"), key_of("")}) == 3


def test_keys_tell_apart_where_one_text_ends(kernels: Path) -> None:
    assert KEY != OTHER
    assert key_of("one", "2") == KEY


def test_the_folder_is_made_for_this_user_alone(kernels: Path) -> None:
    keep(KEY, CODE)
    for made in (kernels, kernels.parent):
        assert stat.S_IMODE(made.stat().st_mode) == 0o700
    assert not entry(kernels).stat().st_mode & 0o022


@pytest.mark.parametrize("at", [0, 31, 32, 500, -1])
def test_a_damaged_entry_is_nothing(kernels: Path, at: int) -> None:
    keep(KEY, CODE)
    raw = bytearray(entry(kernels).read_bytes())
    raw[at] ^= 1
    entry(kernels).write_bytes(raw)
    assert load(KEY) is None
    keep(KEY, CODE)
    assert load(KEY) == CODE


@pytest.mark.parametrize("size", [0, 7, 32, 100])
def test_a_cut_entry_is_nothing(kernels: Path, size: int) -> None:
    keep(KEY, CODE)
    os.truncate(entry(kernels), size)
    assert load(KEY) is None


def test_an_entry_under_the_name_of_another_is_nothing(kernels: Path) -> None:
    keep(KEY, CODE)
    entry(kernels).rename(entry(kernels, OTHER))
    assert load(OTHER) is None
    entry(kernels, OTHER).rename(entry(kernels))
    assert load(KEY) == CODE


@pytest.mark.parametrize("mode", [0o620, 0o602, 0o666])
def test_a_file_that_others_may_write_is_not_loaded(kernels: Path, mode: int) -> None:
    keep(KEY, CODE)
    entry(kernels).chmod(mode)
    assert load(KEY) is None
    entry(kernels).chmod(0o600)
    assert load(KEY) == CODE


@pytest.mark.parametrize("mode", [0o720, 0o702, 0o777])
def test_a_folder_that_others_may_write_is_neither_read_nor_written(
    kernels: Path, mode: int
) -> None:
    keep(KEY, CODE)
    kernels.chmod(mode)
    assert load(KEY) is None
    keep(OTHER, CODE)
    kernels.chmod(0o700)
    assert load(KEY) == CODE
    assert load(OTHER) is None


def test_what_belongs_to_another_user_is_neither_read_nor_written(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep(KEY, CODE)
    me = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: me + 1)
    assert load(KEY) is None
    keep(OTHER, CODE)
    monkeypatch.setattr(os, "geteuid", lambda: me)
    assert load(KEY) == CODE
    assert load(OTHER) is None


def test_a_link_in_place_of_the_folder_or_a_file_is_not_followed(
    kernels: Path, tmp_path: Path
) -> None:
    keep(KEY, CODE)
    entry(kernels).rename(tmp_path / "code")
    entry(kernels).symlink_to(tmp_path / "code")
    assert load(KEY) is None
    keep(KEY, CODE)
    assert entry(kernels).is_symlink()
    entry(kernels).unlink()
    keep(KEY, CODE)
    assert load(KEY) == CODE
    kernels.rename(tmp_path / "moved")
    kernels.symlink_to(tmp_path / "moved")
    assert load(KEY) is None
    keep(OTHER, CODE)
    assert not (tmp_path / "moved" / f"{OTHER}.kernel").exists()


def test_a_pipe_or_a_folder_in_place_of_a_file_is_nothing(kernels: Path) -> None:
    keep(KEY, CODE)
    entry(kernels).unlink()
    os.mkfifo(entry(kernels))
    assert load(KEY) is None
    keep(KEY, CODE)
    entry(kernels).unlink()
    entry(kernels).mkdir()
    assert load(KEY) is None
    keep(KEY, CODE)


def test_what_was_used_the_longest_time_ago_goes_first(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(code_cache, "MOST_BYTES", 4 * (len(CODE) + 32))
    keys = [key_of(str(n)) for n in range(6)]
    for n, key in enumerate(keys[:4]):
        keep(key, CODE)
        os.utime(entry(kernels, key), (n, n))
    (kernels / "mine.txt").write_text("not an entry")
    assert load(keys[0]) == CODE  # which makes it the last one used
    keep(keys[4], CODE)
    assert load(keys[1]) is None
    assert load(keys[0]) == load(keys[2]) == load(keys[3]) == load(keys[4]) == CODE
    for key in keys:
        keep(key, CODE)
    left = [path for path in kernels.iterdir() if path.suffix == ".kernel"]
    assert len(left) == 4
    assert (kernels / "mine.txt").exists()


def test_what_a_killed_process_was_writing_counts_and_goes(
    kernels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep(KEY, CODE)
    part = kernels / f".{OTHER}.kernel.x1y2"
    part.write_bytes(CODE)
    os.utime(part, (0, 0))
    monkeypatch.setattr(code_cache, "MOST_BYTES", len(CODE) + 50)
    keep(KEY, CODE)
    assert not part.exists()
    assert load(KEY) == CODE


@pytest.mark.parametrize("number", ["ENOSPC", "EROFS", "EACCES", "EDQUOT"])
def test_where_nothing_can_be_written_nothing_is_kept_and_nothing_fails(
    kernels: Path, monkeypatch: pytest.MonkeyPatch, number: str
) -> None:
    import errno

    def full(*_: object, **more: object) -> None:
        raise OSError(getattr(errno, number), number)

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", full)
        keep(KEY, CODE)
    assert load(KEY) is None
    assert not list(kernels.iterdir())  # nor is a part of it left
    with monkeypatch.context() as patched:
        patched.setattr(Path, "mkdir", full)
        keep(KEY, CODE)
    keep(KEY, CODE)
    assert load(KEY) == CODE


def test_several_processes_that_keep_and_load_get_whole_entries(kernels: Path) -> None:
    work = (
        "import sys; from verify import code_cache as c\n"
        "c.MOST_BYTES = 100_000\n"
        "me = sys.argv[1]\n"
        "for n in range(150):\n"
        "    key = c.key_of(str(n % 7)); found = c.load(key)\n"
        "    assert found is None or found in {bytes([k]) * 20_000 for k in b'abc'}, key\n"
        "    c.keep(key, me.encode() * 20_000)\n"
    )
    started = [subprocess.Popen([sys.executable, "-c", work, me]) for me in "abc"]
    assert [each.wait() for each in started] == [0, 0, 0]
    names = [path.name for path in kernels.iterdir()]
    assert names
    assert all(name.endswith(".kernel") and not name.startswith(".") for name in names)


# -- where it is ----------------------------------------------------------------------------------


def test_off_keeps_nothing(kernels: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keep(KEY, CODE)
    monkeypatch.setenv(VARIABLE, OFF)
    assert folder() is None
    assert load(KEY) is None
    keep(OTHER, CODE)
    assert [path.name for path in kernels.iterdir()] == [f"{KEY}.kernel"]


def test_without_the_variable_it_is_where_caches_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "")  # which is as if it were not there
    monkeypatch.setenv("XDG_CACHE_HOME", "/caches")
    assert folder() == Path("/caches/areaproof/kernels")
    monkeypatch.setenv("XDG_CACHE_HOME", "caches")
    monkeypatch.setenv("HOME", "/somebody")
    assert folder() == Path("/somebody/.cache/areaproof/kernels")

    def homeless() -> Path:
        raise RuntimeError

    monkeypatch.setattr(Path, "home", homeless)
    assert folder() is None


def test_a_variable_that_names_no_folder_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    for value in ("cache", "no", str(tmp_path / "file")):
        monkeypatch.setenv(VARIABLE, value)
        with pytest.raises(InputError, match=r"VERIFY_CACHE=.*: .*folder.*, or off"):
            folder()
