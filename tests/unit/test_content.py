"""Content is found in a checkout and in a wheel, and the face of the package is what it says."""

import importlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import verify
from tests.paths import ROOT
from verify import content as found
from verify.content import content, shipped_files


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


def test_a_checkout_without_content_says_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(found, "_package", lambda: tmp_path / "verify")
    assert not content("reports").exists()
    assert shipped_files() == {}


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


def test_python_m_verify_is_the_command() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "verify", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("verify, version")
