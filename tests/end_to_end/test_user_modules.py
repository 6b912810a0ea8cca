"""Modules of the user's folder: the named one is imported, and none in a library's place."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT

STEP = """
def step(q, p, h):
    p = p - h * q
    return q + h * p, p

def turn(z):
    p1, p2, q1, q2 = z
    return q1, q2, -p1, -p2

def swap(p, q):
    return q, -p
"""
LOUD = "print('shadowed ' + __name__)\nraise SystemExit(7)\n"
OSCILLATOR = ["--hamiltonian", "p**2/2 + q**2/2"]
LIBRARIES = [
    "numpy",
    "difflib",
    "sympy",
    "mpmath",
    "gmpy2",
    "decimal",
    "ast",
    "json",
    "rich",
    "flint",
]


def verify(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "verify", *arguments], cwd=folder, capture_output=True, text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT), "PYTHONSAFEPATH": "1"}, timeout=120, check=False,
    )  # fmt: skip


def written(folder: Path, **modules: str) -> None:
    for name, text in modules.items():
        folder.joinpath(f"{name}.py").write_text(text)


@pytest.mark.left_to_ci
@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["check-integrator", "mine:step", *OSCILLATOR], 0, "mine:step"),
        (["check-integrator", "mine.py:step", *OSCILLATOR], 0, "mine.py:step"),
        (["check-integrator", "mine:stp", *OSCILLATOR], 2, "is step meant?"),
        (["check-integrator", "./mine.py:stp", *OSCILLATOR], 2, "is step meant?"),
        (["check-map", "mine:swap"], 0, "mine:swap"),
        (["check-map", "mine:turn", "--degrees", "2"], 0, "mine:turn"),
    ],
)
def test_no_library_is_taken_from_the_folder_of_the_user(
    arguments: list[str], status: int, said: str, tmp_path: Path
) -> None:
    written(tmp_path, mine=STEP, **dict.fromkeys(LIBRARIES, LOUD))
    done = verify(tmp_path, *arguments)
    assert "shadowed" not in done.stdout + done.stderr
    assert (done.returncode, said in done.stdout + done.stderr) == (status, True), done.stderr


@pytest.mark.left_to_ci
@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["queue", "statistics", "test", "click", "tests", "difflib"])
@pytest.mark.parametrize("suffix", ["", ".py"])
def test_a_module_that_is_called_as_a_library_is_still_the_users_own(
    name: str, suffix: str, tmp_path: Path
) -> None:
    written(tmp_path, **{name: STEP})
    assert verify(tmp_path, "check-map", f"{name}{suffix}:swap").returncode == 0
    # What is lacking in it is told by difflib, which is Python's.
    missing = verify(tmp_path, "check-map", f"{name}{suffix}:swp")
    assert missing.returncode == 2
    assert "is swap meant? it has: swap" in missing.stderr


def test_what_the_module_imports_from_its_folder_is_found(tmp_path: Path) -> None:
    written(tmp_path, helper=STEP, mine="from helper import swap")
    assert verify(tmp_path, "check-map", "mine:swap").returncode == 0
    other = tmp_path / "elsewhere"
    other.mkdir()
    assert verify(other, "check-map", "../mine.py:swap").returncode == 0


@pytest.mark.parametrize("package", ["own", "test"])  # the second is one of Python's
def test_a_package_is_imported_with_what_it_imports_of_itself(package: str, tmp_path: Path) -> None:
    folder = tmp_path / package
    folder.mkdir()
    written(folder, __init__="", inside="from .deeper import swap", deeper=STEP)
    assert verify(tmp_path, "check-map", f"{package}.inside:swap").returncode == 0


def test_a_folder_without_code_is_no_package_before_an_installed_one(tmp_path: Path) -> None:
    (tmp_path / "numpy").mkdir()
    done = verify(tmp_path, "check-map", "numpy:swap")
    assert done.returncode == 2
    assert "numpy has no swap" in done.stderr


def test_a_module_that_fails_is_no_module_the_second_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from verify.integrators.user_code.loading import from_folder

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    written(tmp_path, queue="raise LookupError")
    for _ in range(2):
        with pytest.raises(LookupError):
            from_folder("queue")
