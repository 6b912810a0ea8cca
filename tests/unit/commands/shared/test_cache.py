"""--no-cache and VERIFY_CACHE, as the commands that compile kernels take them."""

import os
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from verify.arithmetic.compiled import engine
from verify.code_cache import VARIABLE
from verify.commands.main import cli
from verify.errors import InputError
from verify.kernels.kernel import kernel_for

START = "--scheme lie2 --step-size 0.01 --steps 5 --q 1 --p 0 --digits 20"
RUN = f"run --system pendulum --arithmetic fixed {START}".split()


def ask(*arguments: str) -> Result:
    """The command in a process that has compiled nothing yet."""
    kernel_for.cache_clear()
    engine._cached_function.cache_clear()
    return CliRunner().invoke(cli, arguments)


@pytest.fixture
def kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


def test_a_run_keeps_its_kernel_and_takes_it_up_again(kernels: Path) -> None:
    first = ask(*RUN)
    kept = {path.name: path.stat().st_ino for path in kernels.iterdir()}
    assert len(kept) == 2  # and H, as it was read
    again = ask(*RUN)
    assert {path.name: path.stat().st_ino for path in kernels.iterdir()} == kept
    numbers = [result.output.partition(" steps in ")[0] for result in (first, again)]
    assert numbers[0] == numbers[1]
    assert (first.exit_code, again.exit_code) == (0, 0)


@pytest.mark.parametrize("command", ["run", "separate", "report", "check", "stability", "bench"])
def test_no_cache_is_an_option_of_what_compiles(command: str) -> None:
    assert "--no-cache" in ask(command, "--help").output


def test_no_cache_reads_and_writes_nothing_and_is_over_with_the_command(kernels: Path) -> None:
    assert ask(*RUN, "--no-cache").exit_code == 0
    assert not kernels.exists()
    assert os.environ[VARIABLE] == str(kernels.parent)
    ask(*RUN)
    kept = [*kernels.iterdir()]
    for path in kept:
        os.utime(path, (0, 0))
    ask(*RUN, "--no-cache")
    assert [path.stat().st_mtime for path in kept] == [0, 0]
    ask(*RUN)
    assert all(path.stat().st_mtime > 0 for path in kept)


def test_a_folder_that_is_none_is_refused_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    for value in ("here", str(tmp_path / "file")):
        monkeypatch.setenv(VARIABLE, value)
        error = ask(*RUN).exception
        assert isinstance(error, InputError)
        assert str(error).startswith(f"VERIFY_CACHE={value}: ")
        assert ask(*RUN, "--no-cache").exit_code == 0
        assert ask("schemes").exit_code == 0  # which compiles nothing


def test_a_folder_that_cannot_be_made_keeps_nothing_and_stops_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(VARIABLE, "/proc/none/cache")
    assert ask(*RUN).exit_code == 0
