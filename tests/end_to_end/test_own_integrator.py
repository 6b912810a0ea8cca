"""The README's property test of somebody's own step, run as it is printed, and with errors."""

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.paths import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
SECTION = README.partition("<!-- own-integrator -->")[2].partition("\n## ")[0]
EXAMPLE = re.search(r"```python\n(.*?)```", SECTION, re.DOTALL)
SHOWN = re.search(r"```\n(.*?)```", SECTION.partition("simplest failure:")[2], re.DOTALL)


def by_pytest(text: str, folder: Path) -> subprocess.CompletedProcess[str]:
    (folder / "test_mine.py").write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir=.",
               "--hypothesis-seed=0", "test_mine.py"]  # fmt: skip
    paths = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "PYTHONPATH": paths}
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment)


def planted(old: str, new: str) -> str:
    assert EXAMPLE
    assert EXAMPLE[1].count(old) == 1
    return EXAMPLE[1].replace(old, new)


def test_the_example_passes(tmp_path: Path) -> None:
    assert EXAMPLE
    done = by_pytest(EXAMPLE[1], tmp_path)
    assert done.returncode == 0, done.stdout
    assert "1 passed" in done.stdout


def test_a_flipped_sign_fails_and_shrinks_to_what_the_readme_shows(tmp_path: Path) -> None:
    done = by_pytest(planted("p = p - h * h_q", "p = p + h * h_q"), tmp_path)
    assert done.returncode == 1
    assert SHOWN
    # What stands behind the values in comments is hypothesis's to say.
    for line in SHOWN[1].splitlines():
        assert line.partition("#")[0].strip() in done.stdout, done.stdout


def test_an_error_of_one_in_a_million_fails_as_simply(tmp_path: Path) -> None:
    done = by_pytest(planted("p - h * h_q", "p - 1.000001 * h * h_q"), tmp_path)
    assert done.returncode == 1
    assert "expression=p**2/2 + q**2/2" in done.stdout, done.stdout
