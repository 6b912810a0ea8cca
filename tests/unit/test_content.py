"""Content is found in a checkout and in a wheel, and the face of the package is what it says."""

import importlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import verify
from tests.paths import ROOT
from verify import content as found
from verify.content import content, is_shipped, shipped_files


def test_in_a_checkout_the_content_lies_beside_the_package() -> None:
    assert content("reports", "paper", "claims.toml").is_file()
    assert content("reference", "data") == ROOT / "reference" / "data"


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """A package as a wheel installs it, with a folder beside it that is somebody else's."""
    package = tmp_path / "verify"
    shutil.copytree(ROOT / "verify", package, ignore=shutil.ignore_patterns("__pycache__"))
    for folder in ("reports", "reference"):
        shutil.copytree(ROOT / folder, package / "data" / folder)
    (tmp_path / "reports" / "paper").mkdir(parents=True)
    (tmp_path / "reports" / "paper" / "claims.toml").write_text("somebody else's\n")
    return tmp_path


SAID = "from verify.content import content; print(content('reports', 'paper', 'claims.toml'))"


def test_in_a_wheel_it_lies_within_and_nothing_beside_is_read(installed: Path) -> None:
    command = [sys.executable, "-P", "-c", SAID]
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env={"PYTHONPATH": str(installed)}
    )
    path = Path(done.stdout.strip())
    assert path == installed / "verify" / "data" / "reports" / "paper" / "claims.toml"
    assert path.read_bytes() == content("reports", "paper", "claims.toml").read_bytes()


def test_what_is_shipped_has_the_same_names_in_both(installed: Path) -> None:
    names = set(shipped_files())
    assert names == set(shipped_files(installed / "verify"))
    assert {"verify/__init__.py", "reports/paper/claims.toml", "verify/pages/templates/page.html",
            "reference/data/manifest.json", "verify/py.typed"} <= names  # fmt: skip
    assert not [name for name in names if "__pycache__" in name or name.startswith("verify/data/")]


@pytest.mark.parametrize(
    "beside", [(), ("reports",), ("reports", "reference"), ("pyproject.toml",)]
)
def test_without_its_content_nothing_beside_is_taken_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, beside: tuple[str, ...]
) -> None:
    for name in ("verify", "verify/data", *beside):
        (tmp_path / name).mkdir()
    monkeypatch.setattr(found, "_package", lambda: tmp_path / "verify")
    for ask in (lambda: content("reports"), shipped_files):
        with pytest.raises(RuntimeError, match="neither a checkout nor whole"):
            ask()


def test_what_editors_and_systems_leave_behind_is_not_shipped(installed: Path) -> None:
    before = shipped_files(installed / "verify")
    content = installed / "verify" / "data" / "reports"
    for name in (".DS_Store", "paper/claims.toml~", "paper/.claims.toml.swp"):
        (content / name).write_text("left\n")
    assert shipped_files(installed / "verify") == before
    (content / "paper" / "more.toml").write_text("shipped\n")
    assert set(shipped_files(installed / "verify")) - set(before) == {"reports/paper/more.toml"}


def test_what_lies_in_the_package_or_the_content_is_shipped() -> None:
    for inside in (
        "verify",
        "verify/pages/new",
        "reports/mine/kept",
        "reference/../reference/data",
    ):
        assert is_shipped(ROOT / inside)
    for outside in ("paper-report", "reports-of-mine", "reference/../mine", ".."):
        assert not is_shipped(ROOT / outside)


@pytest.mark.parametrize("name", verify.__all__)
def test_every_public_name_is_there(name: str) -> None:
    assert getattr(verify, name) is not None


@pytest.mark.parametrize(
    "module", ["strategies", "testing", "schemes", "errors", "verdict", "pages.plotting"]
)
def test_public_modules_stay_where_the_readme_says(module: str) -> None:
    assert importlib.import_module(f"verify.{module}")


def test_what_is_no_public_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        verify.nothing  # noqa: B018


def test_python_m_verify_imports_nothing_of_its_own_from_the_current_folder(
    tmp_path: Path,
) -> None:
    # Python has imported its own -m, and `verify`, by the time that we can look at the path.
    modules = ["click", "fnmatch", "pathlib", "random", "signal", "socket", "sympy", "flint"]
    for name in modules:
        (tmp_path / f"{name}.py").write_text("raise SystemExit('run')\n")
    done = subprocess.run(
        [sys.executable, "-m", "verify", "prove", "--system", "duffing", "--scheme", "lie1"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def test_a_path_that_is_safe_already_keeps_its_first_entry(tmp_path: Path) -> None:
    asked = (
        "import runpy, sys; sys.argv = ['verify', '--version']\n"
        "runpy.run_module('verify', run_name='__main__'); print(sys.path[0])"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", asked], capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
    )  # fmt: skip
    assert done.stdout.splitlines()[-1] == str(tmp_path)


def test_python_m_verify_is_the_command() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "verify", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("verify, version")
