"""The property test of docs/how-to/tests-of-your-own.md, run as it is printed, and with errors."""

import os
import re
import subprocess
import sys

import pytest

from tests.helpers.pages.blocks import PAGES, blocks
from tests.paths import ROOT

BLOCKS = blocks(PAGES["docs/how-to/tests-of-your-own.md"])
(EXAMPLE,) = (block.text for block in BLOCKS if block.file == "test_mine.py")
(SHOWN,) = (block.text for block in BLOCKS if block.before.endswith("shows the simplest failure:"))

# Three programs, by one pytest: as it is printed, with a flipped sign, with a small error.
PLANTED = {
    "right": ("p = p - h * h_q", "p = p - h * h_q"),
    "flipped": ("p = p - h * h_q", "p = p + h * h_q"),
    "millionth": ("p - h * h_q", "p - 1.000001 * h * h_q"),
}
# What else would fail is not asked for: it takes longer than all the rest.
PROFILE = """
from hypothesis import Phase, settings
settings.register_profile("brief", settings(), phases=[Phase.generate, Phase.shrink])
settings.load_profile("brief")
"""


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What pytest says of the three, of which two fail."""
    folder = tmp_path_factory.mktemp("own")
    (folder / "conftest.py").write_text(PROFILE, encoding="utf-8")
    for name, (old, new) in PLANTED.items():
        assert EXAMPLE.count(old) == 1
        text = EXAMPLE.replace(old, new).replace("def test_step", f"def test_{name}_step")
        (folder / f"test_{name}.py").write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--rootdir=.",
               "--hypothesis-seed=0", "-v"]  # fmt: skip
    paths = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "PYTHONPATH": paths}
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment)
    assert done.returncode == 1, done.stdout
    assert "2 failed, 1 passed" in done.stdout
    return done.stdout


def failure(said: str, name: str) -> str:
    """What is said of that program's failure alone."""
    _, *parts = re.split(r"^_{3,} (test_\w+) _{3,}$", said, flags=re.MULTILINE)
    return dict(zip(parts[::2], parts[1::2], strict=True))[f"test_{name}_step"]


def values(text: str) -> str:
    """What is told of values, without comments and lines, which are hypothesis's to make."""
    lines = (re.sub(r"^E\s", "", line).partition("#")[0] for line in text.splitlines())
    return "".join("".join(lines).split()).replace(",)", ")").removesuffix(",")


@pytest.mark.left_to_ci
def test_the_example_passes(said: str) -> None:
    assert re.search(r"test_right_step PASSED", said), said


@pytest.mark.left_to_ci
def test_a_flipped_sign_fails_and_shrinks_to_what_the_page_shows(said: str) -> None:
    assert "q=Fraction(1, 1)" in SHOWN
    assert values(SHOWN) in values(failure(said, "flipped")), said


def test_an_error_of_one_in_a_million_fails_as_simply(said: str) -> None:
    assert "Hamiltonian(p**2/2 + q**2/2)" in failure(said, "millionth"), said
