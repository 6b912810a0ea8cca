"""The source is part of a result's name, all of it that can change one."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.helpers.constructed.plans import kept_in
from tests.paths import ROOT
from verify import content as shipped
from verify.execution import keeper, provenance
from verify.execution.execute import execute
from verify.execution.executors import THIS_PROCESS
from verify.execution.keeper import fingerprint
from verify.execution.plan import Plan


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the package and of its content, of which the fingerprint is then made."""
    root = tmp_path / "copy"
    for folder in ("verify", "reports", "reference"):
        shutil.copytree(ROOT / folder, root / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", root)
    monkeypatch.setattr(shipped, "_package", lambda: root / "verify")
    fingerprint.cache_clear()
    yield root
    monkeypatch.undo()
    fingerprint.cache_clear()


def fresh() -> str:
    fingerprint.cache_clear()
    return fingerprint()


def one_file_of_each_folder() -> list[str]:
    """Of each folder of the package, whatever kind of file, and of each folder of the content."""
    files: dict[Path, Path] = {}
    for folder in ("verify", "reports", "reference"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                files.setdefault(path.parent, path)
    return [str(path.relative_to(ROOT)) for path in files.values()]


@pytest.mark.left_to_ci
def test_the_fingerprint_covers_every_room_and_all_data(copy: Path) -> None:
    first = fresh()
    assert first == fresh(), "the same code has the same name"
    names = one_file_of_each_folder()
    assert set(names) <= set(shipped.shipped_files()), "of which it is the digest"
    rooms = {Path(name).parts[:2]: name for name in names}
    assert len([room for room in rooms if room[0] == "verify"]) >= 18
    seen = {first}
    for name in rooms.values():
        raw = (copy / name).read_bytes()
        (copy / name).write_bytes(raw + b" ")
        seen.add(fresh())
        (copy / name).write_bytes(raw)
    assert len(seen) == len(rooms) + 1, "each change gives another name"
    assert fresh() == first
    (copy / "verify" / "algebra" / "new.py").touch()
    assert fresh() not in seen, "and so does a file that is new"


def test_a_wheel_and_its_checkout_have_one_fingerprint(copy: Path) -> None:
    checkout = fresh()
    for folder in ("reports", "reference"):
        shutil.move(copy / folder, copy / "verify" / "data" / folder)
    assert fresh() == checkout


def test_what_python_writes_itself_does_not_count(copy: Path) -> None:
    first = fresh()
    (copy / "verify" / "algebra" / "__pycache__").mkdir()
    (copy / "verify" / "algebra" / "__pycache__" / "ring.pyc").write_bytes(b"compiled")
    assert fresh() == first


LIBRARIES = (
    "areaproof", "gmpy2", "hypothesis", "llvmlite", "mpmath", "numpy", "python-flint",
    "sympy",
)  # fmt: skip


@pytest.mark.parametrize("library", LIBRARIES)
def test_another_version_of_a_library_has_another_fingerprint(
    library: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """hypothesis too: what a seed draws depends on it."""
    first = fresh()
    for module in (keeper, provenance):
        own = module.version
        monkeypatch.setattr(module, "version", lambda x, own=own: own(x) + "1" * (x == library))
    other = fresh()
    monkeypatch.undo()
    assert other != first == fresh()


def test_another_source_does_not_take_up_the_results_of_this_one(
    tmp_path: Path, plan: Plan, copy: Path
) -> None:
    store = kept_in(tmp_path)
    execute(plan, store, where=THIS_PROCESS)
    assert all(store.get(name, task) is not None for name, task in plan.tasks.items())
    path = copy / "verify" / "schemes" / "methods" / "taylor" / "lie.py"
    path.write_text(path.read_text() + "\n")
    fresh()
    assert all(store.get(name, task) is None for name, task in plan.tasks.items())
