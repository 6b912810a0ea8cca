"""A user who does what a page says, from its first line to its last, in a folder of their own."""

import contextlib
import doctest
import io
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from itertools import takewhile
from pathlib import Path
from typing import Any
from unittest.mock import patch

import click

from tests.helpers.pages.blocks import Block, agrees, blocks, commands, difference
from tests.helpers.programs.compilers import needed
from tests.paths import ROOT
from verify.commands.main import cli, main

# What else a page may tell to start, where nothing of it is run here.
OTHERS = {
    "coqc",
    "python3",
    "python",
    "pip",
    "pytest",
    "dask",
    ".",
    "eval",
    "cc",
    "gfortran",
    "julia",
    "rustc",
}


class PageError(AssertionError):
    """A page says what is not so; the message begins with the line of the block."""


class Session:
    """Plays the blocks of one page in the current folder.

    `names`: what its Python defines, all blocks together. `ran`: how many commands were compared
    with what they print. `by_hand`: what takes long is done too, as a person does it.
    """

    def __init__(self, *, by_hand: bool = False) -> None:
        self.names: dict[str, Any] = {"__name__": "page"}
        self.ran = 0
        self.by_hand = by_hand
        self._status = 0  # of the last command
        self._kinds = {"console": self._console, "sh": self._sh, "python": self._python,
                       "pycon": self._pycon, "text": self._text}  # fmt: skip

    def play(self, block: Block) -> None:
        try:
            if block.file:
                self._save(block)
            elif block.is_by_hand and (block.last_run is None or not self.by_hand):
                self._sh(_typed(block))
            elif block.is_by_hand and block.language == "sh":
                _by_shell(block.text)
            elif block.language not in self._kinds:
                raise ValueError(f"a block of {block.language!r} is neither saved nor started")
            else:
                self._kinds[block.language](block.text)
        except Exception as error:
            raise PageError(f"line {block.line}: {error}") from error

    def _save(self, block: Block) -> None:
        with Path(block.file).open("a" if block.is_appended else "x", encoding="utf-8") as file:
            if block.is_appended:
                assert file.tell(), f"{block.file} is not there yet"
                file.write("\n")
            file.write(block.text)

    def _console(self, text: str) -> None:
        for command, shown in commands(text):
            if command == "echo $?":
                printed, self._status = f"{self._status}\n", 0
            else:
                assert not self._status, f"the page does not say that the status is {self._status}"
                self._status, printed = started(command)
                self.ran += 1
            lines = printed.splitlines()
            assert agrees(shown, lines), f"{command}\n{difference(shown, lines)}"
        assert not self._status, f"the page does not say that the status is {self._status}"

    def _sh(self, text: str) -> None:
        """Set-up, and what takes minutes: no more than that our commands have these options."""
        for line in text.replace("\\\n", " ").splitlines():
            for part in line.split("&&"):
                words = [*takewhile(">".__ne__, shlex.split(part, comments=True))]
                if not words or words[0].startswith("./"):  # what a compiler has made
                    continue
                program = words[0].rpartition("/")[2]
                if program == "verify":
                    parse(words[1:])
                else:
                    assert program in OTHERS, f"{program} is not known here"

    def _python(self, text: str) -> None:
        exec(text, self.names)  # noqa: S102 - the page's own

    def _pycon(self, text: str) -> None:
        test = doctest.DocTestParser().get_doctest(text, self.names, "page", None, None)
        told: list[str] = []
        runner = doctest.DocTestRunner(verbose=False)
        found = runner.run(test, out=told.append, clear_globs=False)
        self.names.update(test.globs)
        self.ran += found.attempted
        assert found.attempted, "there is no >>> in it"
        assert not found.failed, "".join(told)

    def _text(self, text: str) -> None:
        """What no command of the page prints; a test of its own looks at it."""


def _typed(block: Block) -> str:
    """The commands of a block, one a line, without what they print."""
    if block.language != "console":
        return block.text
    return "\n".join(command for command, _ in commands(block.text) if command != "echo $?")


def _by_shell(text: str) -> None:
    """What stands in an `sh` block, by a shell that finds `verify` beside this Python."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path, "PYTHONPATH": str(ROOT)}
    subprocess.run(["bash", "-euc", text], check=True, env=environment)


def started(command: str) -> tuple[int, str]:
    """The exit status of a command and what it prints."""
    words = shlex.split(command)
    into = words.pop() if len(words) > 2 and words[-2] == ">" else ""
    if into:
        words.pop()
    status, printed = PROGRAMS[words[0]](words[1:])
    if not into:
        return status, printed
    Path(into).write_text(printed, encoding="utf-8")
    return status, ""


def _verify(arguments: list[str]) -> tuple[int, str]:
    """The command in this process, as it writes where nobody looks at a terminal."""
    written, status = io.StringIO(), 0
    with contextlib.redirect_stdout(written), contextlib.redirect_stderr(written):
        try:
            main(arguments)
        except SystemExit as exit_:
            status = int(str(exit_.code or 0))
    return status, written.getvalue()


def _python(arguments: list[str]) -> tuple[int, str]:
    command = [sys.executable, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def _cat(arguments: list[str]) -> tuple[int, str]:
    return 0, "".join(Path(name).read_text(encoding="utf-8") for name in arguments)


def _ls(arguments: list[str]) -> tuple[int, str]:
    return 0, "".join(f"{path.name}\n" for path in sorted(Path(*arguments).iterdir()))


def _compiler(name: str) -> Callable[[list[str]], tuple[int, str]]:
    """Where it is missing the page's test is skipped, and fails in CI."""

    def compiled(arguments: list[str]) -> tuple[int, str]:
        command = [needed(name), *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    return compiled


PROGRAMS = {
    "verify": _verify, "python": _python, "cat": _cat, "ls": _ls,
    "gcc": _compiler("gcc"), "gfortran": _compiler("gfortran"),
}  # fmt: skip


def parse(arguments: list[str]) -> None:
    """Read a command line and do nothing; click's error where it has no such command or option."""
    command: click.Command = cli
    context = click.Context(cli, info_name="verify")
    while isinstance(command, click.Group):
        name, found, arguments = command.resolve_command(context, arguments)
        assert found is not None, name
        command = found
        context = click.Context(command, parent=context, info_name=name)
    command.make_context(command.name, list(arguments))


@contextlib.contextmanager
def folder_of_a_user(folder: Path) -> Iterator[None]:
    """Be in that folder, beside the repository's `reference`; what is imported there is let go, as
    is what other tests have imported from folders of theirs, whose files may have the same names.

    All is done in this process, as on a machine with one core: no result depends on that.
    """
    (folder / "reference").symlink_to(ROOT / "reference")
    _forget(Path(tempfile.gettempdir()))
    path = list(sys.path)
    environment = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    with (
        contextlib.chdir(folder),
        patch.dict(os.environ, environment, clear=True),
        patch("os.cpu_count", return_value=1),
    ):
        try:
            yield
        finally:
            sys.path[:] = path
            _forget(folder)


def _forget(folder: Path) -> None:
    """Let go of all modules whose files are in that folder, but for those of this checkout and of
    the environment that Python runs in, which may lie there, too."""
    spared = tuple(f"{path}{os.sep}" for path in (ROOT, sys.prefix, sys.base_prefix))
    for name, module in list(sys.modules.items()):
        file = str(getattr(module, "__file__", None) or "")
        if file.startswith(f"{folder}{os.sep}") and not file.startswith(spared):
            del sys.modules[name]


def read_through(page: str, folder: Path, *, by_hand: bool = False) -> Session:
    """Do all that a page says, in that folder, which is empty. PageError where it is not so."""
    session = Session(by_hand=by_hand)
    with folder_of_a_user(folder):
        for block in blocks(page):
            session.play(block)
    return session
