"""Which tests reach which lines of `verify`, found once with coverage.py and kept.

    python -m tests.mutants.reach

runs the suite as CI does, but for the browser's, Rocq's and clusters' tests, with a context for
each test; processes that a test starts count as the test. It takes about twice the suite's time.
`pytest -p tests.mutants.reach` is what it calls.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from functools import cache, cached_property
from pathlib import Path

import pytest

from tests.mutants.mutate import ROOT, path_of

KEPT = Path(__file__).parent / "reached"
_LEFT_OUT = ("tests/browser", "tests/rocq", "tests/end_to_end/clusters", "tests/oracle",
             "tests/unit/test_mutants.py")  # fmt: skip
_SETTINGS = """\
[run]
source = {root}/verify
data_file = {folder}/data
parallel = True
context = ${{PYTEST_CURRENT_TEST}}
patch = subprocess
    _exit
"""


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """A context of its own for each test, and how long it takes the processor."""
    import coverage

    running = coverage.Coverage.current()
    if running is None:
        yield
        return
    running.switch_context(item.nodeid)
    before = os.times()
    yield
    after = os.times()
    running.switch_context("")
    spent = sum(after[:4]) - sum(before[:4])
    with (Path(os.environ["VERIFY_REACHED"]) / f"seconds-{os.getpid()}").open("a") as file:
        file.write(json.dumps([item.nodeid, round(spent, 3)]) + "\n")


class Reach:
    """What was kept in `folder`: tests by the lines that they reach, and their seconds."""

    def __init__(self, folder: Path = KEPT) -> None:
        self.folder = folder
        if not (folder / "data").exists():
            raise SystemExit(f"{folder} has no data; run python -m tests.mutants.reach first")

    @cached_property
    def seconds(self) -> dict[str, float]:
        """Of the processor, by test."""
        lines = [
            json.loads(line)
            for path in self.folder.glob("seconds-*")
            for line in path.read_text(encoding="utf-8").splitlines()
        ]
        return {str(name): float(spent) for name, spent in lines}

    def tests(self, module: str, line: int | None = None) -> list[str]:
        """Those that run this line of the module, or any of it, the cheapest first."""
        found: set[str] = set()
        for each, tests in self._lines(module).items():
            if line in (None, each):
                found |= tests
        return sorted(found, key=lambda name: self.seconds[name])

    @cache  # noqa: B019 - of one object
    def _lines(self, module: str) -> dict[int, set[str]]:
        import coverage

        data = coverage.CoverageData(str(self.folder / "data"))
        data.read()
        by_line = data.contexts_by_lineno(str(path_of(module)))
        return {n: {_plain(x) for x in tests} & self.seconds.keys() for n, tests in by_line.items()}


def _plain(context: str) -> str:
    """The test's name: of a process that it has started, without the stage it was in."""
    for stage in (" (setup)", " (call)", " (teardown)"):
        context = context.removesuffix(stage)
    return context


def main() -> None:
    """Runs the suite; replaces what was kept where that comes to its end."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        settings = folder / "settings"
        settings.write_text(_SETTINGS.format(root=ROOT, folder=folder))
        left = [f"--ignore={name}" for name in _LEFT_OUT]
        command = [sys.executable, "-m", "coverage", "run", f"--rcfile={settings}", "-m", "pytest",
                   "-p", "tests.mutants.reach", "--tb=line", *left, *sys.argv[1:]]  # fmt: skip
        environment = {**os.environ, "CI": "true", "VERIFY_REACHED": str(folder)}
        status = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
        combine = [sys.executable, "-m", "coverage", "combine", "-q", f"--rcfile={settings}"]
        subprocess.run(combine, cwd=ROOT, check=True)
        KEPT.mkdir(exist_ok=True)
        for path in KEPT.iterdir():
            path.unlink()
        for path in folder.iterdir():
            if path.name == "data" or path.name.startswith("seconds-"):
                shutil.copyfile(path, KEPT / path.name)
    print(f"pytest ended with {status}; kept in {KEPT} after {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    main()
