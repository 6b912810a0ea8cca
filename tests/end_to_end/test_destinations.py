"""Every option that names what is written: refused before any work where it cannot be meant."""

from collections.abc import Callable, Iterator
from pathlib import Path

import click
import pytest

from tests.end_to_end.test_command_line import here
from verify.commands import Commands
from verify.commands.shared.destinations import OUT_FILE, OUT_FOLDER
from verify.commands.shared.input import PATH

OF = "--system pendulum --scheme lie2"
RUN = f"{OF} --step-size 0.1 --q 1 --p 0"
FILES = {
    "--csv": f"run {RUN} --steps 10 --csv",
    "--certificate": f"prove {OF} --certificate",
    "--coq": "certificate export lie2.json --coq",
    "--output": f"export {OF} --language c -o",
}
DRAWN = f"bench {RUN} --step-size 0.05 --time 1 -o"
FOLDERS = {
    "--keep": f"run {RUN} --steps 10 --keep",
    "--findings": "report integrators --findings",
    "--errata": "report paper --errata",
    "FOLDER": "certificate theory",
    "--output": f"report {RUN} --steps 10 -o",
}
MORE_FOLDERS = [f"stability {RUN} --time 1 --keep", "reference make -o", "explore --examples 1 -o"]
EACH_FILE = [*FILES.items(), ("--output", DRAWN)]
EACH_FOLDER = [*FOLDERS.items()]
EACH_FOLDER += [("--keep" if "--keep" in x else "--output", x) for x in MORE_FOLDERS]

READ = {
    ("certificate check", "file"),
    ("certificate export", "file"),
    ("reference check", "folder"),
    ("reference compare", "theirs"),
    ("reference compare", "data"),
}


def refused(capsys: pytest.CaptureFixture[str], typed: str, name: str) -> str:
    status, out, err = here(capsys, *typed.split(), name)
    assert (status, out) == (2, ""), (typed, err)
    assert err.count("\n") == 1
    return err


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def params_of(command: click.Command, name: str) -> Iterator[tuple[str, click.Parameter]]:
    if isinstance(command, click.Group):
        for inner, each in command.commands.items():
            yield from params_of(each, f"{name} {inner}")
    else:
        yield from ((name, param) for param in command.params)


def test_every_path_is_read_or_named_here() -> None:
    """So that an option that is new, and writes, is of the kind that is looked at before."""
    every = [x for name, each in Commands().items() for x in params_of(each, name)]
    assert {(name, str(x.name)) for name, x in every if x.type is PATH} == READ
    files = {x.opts[-1] for _, x in every if x.type is OUT_FILE}
    folders = {x.opts[-1] for _, x in every if x.type is OUT_FOLDER}
    assert files == set(FILES)
    assert folders == {x if x.startswith("-") else x.lower() for x in FOLDERS}


@pytest.mark.parametrize(("option", "typed"), [*EACH_FILE, *EACH_FOLDER])
def test_nothing_is_made_in_a_folder_that_is_not_there(
    option: str, typed: str, capsys: pytest.CaptureFixture[str], folder: Path
) -> None:
    name = "nowhere/x.svg" if typed == DRAWN else "nowhere/x"
    said = refused(capsys, typed, name)
    assert said.startswith(f"verify: {option}={name}: there is no folder nowhere; make it first")
    assert list(folder.iterdir()) == []


PUT: dict[str, Callable[[Path], None]] = {
    "is a folder": Path.mkdir,
    "is a link": lambda path: path.symlink_to("mine"),
    "is read-only": lambda path: path.touch(0o400),
}


@pytest.mark.parametrize(("option", "typed"), EACH_FILE)
@pytest.mark.parametrize(("problem", "put"), PUT.items(), ids=PUT)
def test_what_is_not_ours_to_replace_is_refused_before_any_work(
    option: str, typed: str, problem: str, put: Callable[[Path], None],
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    put(Path("x.svg"))
    said = refused(capsys, typed, "x.svg")
    assert said.startswith(f"verify: {option}=x.svg: {problem}")


@pytest.mark.parametrize(("option", "typed"), EACH_FOLDER)
@pytest.mark.parametrize("name", ["page.html", "Page.HTML", "paper.md", "data.json", "x.csv"])
def test_a_name_of_a_file_is_no_folders(
    option: str, typed: str, name: str, capsys: pytest.CaptureFixture[str], folder: Path
) -> None:
    said = refused(capsys, typed, name)
    assert said.startswith(f"verify: {option}={name}: names a file; give a folder")
    assert list(folder.iterdir()) == []


def test_a_folder_is_made_under_one_that_is_there(capsys: pytest.CaptureFixture[str]) -> None:
    Path("there").mkdir()
    Path("kept.md").mkdir()  # it is one, however it is called
    for name in ("there/new", "v1.2", "kept.md"):
        assert here(capsys, *FOLDERS["--keep"].split(), name)[0] == 0
        assert Path(name).is_dir()
    for name in ("there/x.csv", "x"):
        assert here(capsys, *FILES["--csv"].split(), name)[0] == 0
        assert Path(name).is_file()
