"""Rocq in tests: what `coqc` takes, and the theory it compiled.

Where `coqc` is missing a test is skipped by name, and fails in CI.
"""

import fcntl
import os
import re
import subprocess
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from tests.helpers.programs.compilers import needed
from verify.proof.assistant import shipped_theory as theory

PROCESSES = 2
LONGEST = 300  # seconds for a file on a machine that does much else
# By itself coqc has 256 MB for young objects, which takes longer to fill than most files to check,
# looks through what it loaded for what may go, of which there is nothing, and asks the system for
# memory in small pieces, a fifth of the time of a short file.
_MEMORY = {
    "OCAMLRUNPARAM": "s=1M,i=32M,o=1000",
    "GLIBC_TUNABLES": "glibc.malloc.hugetlb=1",
}
ENVIRONMENT = {**_MEMORY, **os.environ}


@dataclass(frozen=True)
class Answer:
    """`said`: on standard output; `complaints`: warnings and errors."""

    status: int
    said: str
    complaints: str


def coqc(path: Path, folders: Mapping[str, Path] | None = None) -> Answer:
    """What coqc says of this file, where these names stand for folders of compiled ones."""
    return _coqc(path.parent, *options(folders or {}), path.name)


def _coqc(folder: Path, *arguments: str) -> Answer:
    found = subprocess.run(
        [needed("coqc"), "-q", "-noglob", *arguments],
        cwd=folder,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        timeout=LONGEST,
    )
    return Answer(found.returncode, found.stdout, found.stderr)


def options(folders: Mapping[str, Path]) -> list[str]:
    """By which coqc knows where these names are."""
    return [part for name, place in folders.items() for part in ("-Q", str(place), name)]


def beside(compiled: Path) -> dict[str, Path]:
    """The theory, compiled in that folder, under its name."""
    return {theory.LOGICAL: compiled}


def accepted(path: Path, text: str, folders: Mapping[str, Path] | None = None) -> str:
    """What coqc prints of the text, which it has to take without a word of complaint."""
    path.write_text(text, encoding="utf-8")
    found = coqc(path, folders)
    assert (found.status, found.complaints) == (0, ""), found.complaints
    return found.said


def changed(text: str, old: str, new: str, times: int = 1) -> str:
    """The text with `old` replaced, which stands there so often; a blank is any white space."""
    pattern = r"\s+".join(map(re.escape, old.split()))
    result, count = re.subn(pattern, lambda _: new, text)
    assert count == times, f"{old!r} stands {count} times in the text, and not {times}"
    assert result != text
    return result


def each_after(needs: Mapping[str, Iterable[str]], work: Callable[[str], object]) -> None:
    """Does the work of each name after that of the names it needs, two at a time."""
    sorter = TopologicalSorter(needs)
    sorter.prepare()
    with ThreadPoolExecutor(PROCESSES) as pool:
        running: dict[Future[object], str] = {}
        while sorter.is_active():
            running |= {pool.submit(work, name): name for name in sorter.get_ready()}
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                future.result()
                sorter.done(running.pop(future))


def in_module(name: str, text: str) -> str:
    """The text as a module, by which others name what is in it as if it were a file."""
    return f"Module {name}.\n{text}\nEnd {name}.\n"


def compile_theory(folder: Path) -> None:
    """Installs the theory there, and has coqc compile all of it, by its project file."""
    theory.install(folder)
    given, *listed = (folder / "_CoqProject").read_text(encoding="utf-8").splitlines()
    lines = {Path(line).stem: line for line in listed}

    def compile_one(name: str) -> None:
        found = _coqc(folder, *given.split(), lines[name])
        assert (found.status, found.complaints) == (0, ""), f"{lines[name]}: {found.complaints}"

    each_after({name: theory.imports_of(name) for name in lines}, compile_one)


def made_once(paths: pytest.TempPathFactory, name: str, make: Callable[[Path], None]) -> Path:
    """A folder that one of pytest's processes makes, while the others wait for it."""
    base = paths.getbasetemp()
    # The workers of pytest-xdist have folders of their own in one that is the session's.
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    folder, complete = shared / name, shared / f"{name}.complete"
    failed = shared / f"{name}.failed"
    with (shared / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if failed.exists():
            pytest.fail(failed.read_text(encoding="utf-8"))
        if not complete.exists():
            folder.mkdir(exist_ok=True)
            try:
                make(folder)
            except Exception as error:
                failed.write_text(str(error), encoding="utf-8")
                raise
            complete.touch()
    return folder
