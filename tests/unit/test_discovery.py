"""A catalogue reads file names, and imports only what it is asked for."""

import subprocess
import sys
from pathlib import Path

import pytest

from verify import arithmetic, schemes
from verify.audits import libraries
from verify.discovery import Catalogue
from verify.exploration import properties
from verify.exploration.sample_space import SampleSpace
from verify.exploration.scenes_of_seed import sample_scene
from verify.hamiltonians import systems
from verify.scenes.shapes import named


@pytest.fixture
def catalogue(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Catalogue:
    folder = tmp_path / "kinds_of_things"
    (folder / "wild").mkdir(parents=True)
    for name in ("__init__", "wild/__init__", "wild/big_cat", "dog"):
        (folder / f"{name}.py").write_text(f"NAME = {name!r}\n")
    monkeypatch.syspath_prepend(tmp_path)
    return Catalogue("kinds_of_things", [str(folder)])


def test_files_of_all_folders_are_found_by_name(catalogue: Catalogue) -> None:
    assert catalogue.names == ("big-cat", "dog")
    assert "big-cat" in catalogue
    assert "wild" not in catalogue
    assert catalogue.folder("big-cat") == "wild"
    assert not {name for name in sys.modules if name.startswith("kinds_of_things")}


def test_what_is_asked_for_is_imported_and_no_more(catalogue: Catalogue) -> None:
    assert catalogue.module("big-cat").NAME == "wild/big_cat"
    assert "kinds_of_things.dog" not in sys.modules
    with pytest.raises(KeyError):
        catalogue.module("mouse")


def test_two_files_of_one_name_are_an_error(catalogue: Catalogue) -> None:
    Path(*catalogue.path, "wild", "dog.py").write_text("NAME = 'fox'\n")
    with pytest.raises(RuntimeError, match="two files have one name"):
        _ = catalogue.names


def test_the_order_of_schemes_is_that_of_their_files() -> None:
    # Number k of seed S is the same scene everywhere and always: what is drawn hangs on the order.
    composed = [name for name in schemes.names() if name.startswith("mclachlan")]
    assert composed == ["mclachlan4", "mclachlan4-s4", "mclachlan-atela2"]
    assert sample_scene(SampleSpace(), 7, 10).schemes == ("mclachlan4-s4",)


@pytest.mark.parametrize("kind", [arithmetic, libraries, named, properties, schemes, systems])
def test_each_kind_has_files_and_no_two_of_one_name(kind: object) -> None:
    catalogue: Catalogue = vars(kind)["_FILES"]
    files = [p for folder in catalogue.path for p in Path(folder).rglob("*.py")]
    assert len(catalogue.names) == sum(path.stem != "__init__" for path in files) > 2


ASKED = """
import sys
from verify import schemes, systems
schemes.get("lie2"), systems.get("duffing")
kinds = ("verify.schemes.methods.", "verify.hamiltonians.systems.")
print(sorted(name for name in sys.modules if name.startswith(kinds) and name.count(".") == 4))
"""


def test_a_scheme_and_a_system_bring_no_other() -> None:
    done = subprocess.run([sys.executable, "-c", ASKED], capture_output=True, text=True, check=True)
    assert eval(done.stdout) == [  # noqa: S307 - our own list of texts
        "verify.hamiltonians.systems.plane.duffing",
        "verify.schemes.methods.taylor.lie",
    ]
