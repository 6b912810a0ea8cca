"""hypothesis knows the classes that are drawn, in either order of imports, at no cost to others."""

import os
import subprocess
import sys
import tomllib
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from tests.paths import ROOT

GROUP = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
ENTRIES = GROUP["hypothesis"]

DRAW = """
from hypothesis import Phase, find, settings, strategies as st
quick = settings(database=None, max_examples=1, phases=[Phase.generate])
for cls in (Hamiltonian, Scheme, Scene, InitialValue):
    assert isinstance(find(st.from_type(cls), lambda _: True, settings=quick), cls), cls
print("drawn")
"""
CLASSES = """
from verify import Hamiltonian, Scene, Scheme
from verify.scenes.values import InitialValue
"""
ORDERS = {
    "hypothesis first": "import hypothesis" + CLASSES + DRAW,
    "hypothesis last": CLASSES + "import hypothesis" + DRAW,
    "strategies first": "import verify.strategies" + CLASSES + DRAW,
}


def said(code: str, entries: Path | None, **environment: str) -> str:
    """What a new Python prints, with the project installed as that folder's metadata has it."""
    paths = [str(ROOT), *([str(entries)] if entries else [])]
    known = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **environment}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=known, cwd=ROOT
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """A folder with the entry points of pyproject.toml, as an installer writes them."""
    metadata = tmp_path / "areaproof_drawn-0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: areaproof-drawn\nVersion: 0\n")
    lines = [f"{name} = {value}" for name, value in ENTRIES.items()]
    (metadata / "entry_points.txt").write_text("\n".join(["[hypothesis]", *lines]) + "\n")
    return tmp_path


@pytest.mark.left_to_ci
@pytest.mark.parametrize("order", ORDERS)
def test_the_classes_are_drawn_in_every_order_of_imports(order: str, installed: Path) -> None:
    assert said(ORDERS[order], installed) == "drawn"


@pytest.mark.left_to_ci
@pytest.mark.sample(1)
@pytest.mark.parametrize("order", ["hypothesis first", "strategies first"])
def test_they_are_without_plugins_where_hypothesis_is_loaded_first(
    order: str, installed: Path
) -> None:
    assert said(ORDERS[order], installed, HYPOTHESIS_NO_PLUGINS="1") == "drawn"


def test_to_import_hypothesis_brings_nothing_heavy(installed: Path) -> None:
    code = """
import sys
import hypothesis
heavy = {"sympy", "numpy", "pydantic", "flint"}
print(sorted({"verify", "verify.from_type", *heavy} & set(sys.modules)))
"""
    assert said(code, installed) == "['verify', 'verify.from_type']"


def test_to_import_a_class_does_not_import_hypothesis(installed: Path) -> None:
    code = CLASSES + "import sys; print('hypothesis' in sys.modules)"
    assert said(code, installed) == "False"


def test_the_installed_project_has_the_entry_point() -> None:
    found = {entry.name: entry.value for entry in entry_points(group="hypothesis")}
    if "areaproof" not in found and not os.environ.get("CI"):
        pytest.skip("installed before there was an entry point; install it again")
    assert found["areaproof"] == ENTRIES["areaproof"]
