"""Imports go downwards only, without a circle; what is imported is what is declared."""

import re
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Set
from functools import cache
from pathlib import Path

import pytest

from tests.helpers.imports import (
    MODULES,
    NAMES,
    VERIFY,
    by_name,
    imported,
    relative,
    rooms_of,
    roots,
    texts,
    whole_package,
)
from tests.paths import ROOT

# From the roof down. A module imports from its own room and from those below it.
ROOF = ("verify", "__main__", "from_type", "testing")
ROOMS = ("commands", "calls", "pages", "reference", "exploration", "strategies", "audits",
         "claims", "papers", "studies", "integrators", "runs", "flows", "kernels", "execution",
         "scenes", "proof", "schemes", "hamiltonians", "structures", "algebra", "arithmetic",
         "functions", "observables")  # fmt: skip
GROUND = ("code_cache", "content", "discovery", "drawable", "effort", "errors", "files", "formats",
          "lazy_sympy", "lockstep", "notebook", "prose", "verdict")  # fmt: skip


def floor(name: str) -> int:
    """How far down a module stands; the ground is the lowest."""
    room = rooms_of(name)
    if room in ROOF:
        return 0
    return len(ROOMS) + 1 if room in GROUND else 1 + ROOMS.index(room)


def edges_of(paths: Mapping[str, Path]) -> dict[str, set[str]]:
    """What each module imports of ours: in functions, for types and by name as well."""
    return {name: edges_of_file(path) - {name} for name, path in paths.items()}


def edges_of_file(path: Path) -> set[str]:
    names = {*imported(path, everywhere=True), *texts(path)}
    edges = {deepest(name) for name in names if name.startswith("verify.")}
    # By itself the text "verify" is the command's name, but where modules are imported by name.
    code = bool(by_name(path)) or "verify" in imported(path, everywhere=True)
    return edges | (names & {"verify"} if code else set())


def deepest(text: str) -> str:
    """The deepest module or package that stands at the beginning of a text."""
    parts = re.split(r"[^\w.]", text)[0].split(".")
    names = (".".join(parts[:k]) for k in range(len(parts), 0, -1))
    return next(name for name in names if name in NAMES)


# Where a name that no import statement has is imported, or run, or looked up, and why.
BY_NAME = {
    "verify": {"import_module"},  # public names, when they are used
    "verify.calls.progress": {"modules"},  # IPython, where it is imported
    "verify.discovery": {"import_module"},  # files of a package, by their names
    "verify.lazy_sympy": {"import_module"},  # sympy, when it is asked for something
    "verify.notebook": {"import_module"},  # pandas and xarray, where they are installed
    "verify.from_type": {"modules"},  # hypothesis, where it is imported
    "verify.integrators.user_code.faults": {"modules"},  # numpy, where it is imported
    "verify.integrators.user_code.repetition": {"modules"},  # numpy, and where a function is from
    "verify.integrators.tracing.function_copy": {"builtins", "__import__"},  # the user's code
    "verify.integrators.tracing.purity": {"modules"},  # numpy and others, where they are imported
    "verify.audits.integrators_report": {"import_module"},  # a library that may be broken
    "verify.audits.methods.driver": {"exec"},  # lines of ours, which are shown
    "verify.integrators.user_code.loading": {
        "import_module", "modules", "spec_from_file_location", "exec_module"},  # the user's code
    "verify.arithmetic.number_system": {"exec"},  # kernels
}  # fmt: skip


def upward(edges: Mapping[str, Set[str]]) -> set[tuple[str, str]]:
    """(module, module) where the first imports the second, which stands above it."""
    return {(a, b) for a, below in edges.items() for b in below if floor(b) < floor(a)}


def circles(edges: Mapping[str, Set[str]]) -> list[set[str]]:
    """The sets of names that reach each other; a name's package is not counted as imported."""
    reached: dict[str, set[str]] = {}
    for name in edges:
        seen: set[str] = set()
        waiting = [name]
        while waiting:
            for other in edges[waiting.pop()] - seen:
                seen.add(other)
                waiting.append(other)
        reached[name] = seen
    found = {frozenset(b for b in reached[a] if a in reached[b]) for a in edges if a in reached[a]}
    return [set(circle) for circle in found]


def folders(edges: Mapping[str, Set[str]]) -> dict[str, set[str]]:
    """The same between folders. A folder's face finds what is in it, and is left out."""
    found: dict[str, set[str]] = {}
    for name, below in edges.items():
        for other in below:
            ends = [NAMES[name], NAMES[other]]
            if VERIFY in (ends[0].parent, ends[1].parent) or "__init__.py" in {
                p.name for p in ends
            }:
                continue
            own, its = (str(p.parent.relative_to(VERIFY)) for p in ends)
            found.setdefault(own, set()).update({its} - {own})
            found.setdefault(its, set())
    return found


@cache
def our_edges() -> dict[str, set[str]]:
    """Those of all our modules; read when they are first asked for."""
    return edges_of(NAMES)


def test_every_folder_is_a_room_and_every_room_has_its_floor() -> None:
    assert {rooms_of(name) for name in NAMES} == {*ROOF, *ROOMS, *GROUND}
    python = {path.relative_to(VERIFY).parts for path in MODULES}
    assert sorted(ROOMS) == sorted({parts[0] for parts in python if len(parts) > 1})


def test_imports_go_downwards_only() -> None:
    assert not upward(our_edges())
    assert sum(map(len, our_edges().values())) > 1500, "the edges were read"


@pytest.mark.parametrize(
    "line",
    [
        "from verify.studies.tasks_of_scenes import plan_scenes",
        "import verify.commands.main",
        "def f():\n    from verify.pages import page",
        "from typing import TYPE_CHECKING\n"
        "if TYPE_CHECKING:\n    from verify.runs.requested_run import run",
        "from importlib import import_module\nimport_module('verify.claims.judge')",
        "from verify import testing",
        "from verify import errors, run",
        "from verify import *",
        "from verify.__init__ import run",
        "import verify\ndef f():\n    return verify.run",
        "import_module(f'verify.pages.{name}')",
        "import_module('verify.pages.' + name)",
        "import_module('verify.' + name)",
        "import_module('.pages.page', 'verify')",
        "import_module('verify').run",
        "resolve_name('verify.pages.page:make')",
        "sys.modules['verify'].run",
        "HOMES = {'page': 'verify.pages.page'}",
    ],
)
def test_a_planted_upward_import_is_seen(line: str, tmp_path: Path) -> None:
    path = tmp_path / "ring.py"
    path.write_text(line)
    planted = our_edges() | {"verify.algebra.ring": edges_of_file(path)}
    assert {a for a, _ in upward(planted)} == {"verify.algebra.ring"}


def test_what_a_docstring_or_a_message_says_is_no_import(tmp_path: Path) -> None:
    path = tmp_path / "ring.py"
    path.write_text('"""verify.pages makes pages."""\nNAME = "verify"\nSAID = "see verify.pages"')
    assert not edges_of_file(path)


def test_nothing_imports_the_whole_package() -> None:
    """Of which every module could then be taken as an attribute, unseen by the other tests."""
    assert not {name: found for name, path in NAMES.items() if (found := whole_package(path))}


@pytest.mark.parametrize(
    "line", ["import verify", "import sys, verify.errors", "import verify as v"]
)
def test_a_planted_import_of_the_whole_package_is_seen(line: str, tmp_path: Path) -> None:
    path = tmp_path / "ring.py"
    path.write_text(f"def f():\n    {line}")
    assert whole_package(path)


def test_modules_are_imported_by_name_only_where_that_is_needed() -> None:
    assert {name: found for name, path in NAMES.items() if (found := by_name(path))} == BY_NAME
    assert not {name: found for name, path in NAMES.items() if (found := relative(path))}


@pytest.mark.parametrize(
    "line",
    [
        "from importlib import import_module as get",
        "importlib.import_module(name)",
        "getattr(importlib, 'import_module')(name)",
        "__import__(name)",
        "pkgutil.resolve_name(name)",
        "sys.modules[name]",
        "from sys import modules",
        "import builtins",
        "exec(text)",
    ],
)
def test_a_planted_import_by_name_is_seen(line: str, tmp_path: Path) -> None:
    path = tmp_path / "ring.py"
    path.write_text(line)
    assert by_name(path)


def test_a_planted_relative_import_by_name_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "ring.py"
    path.write_text("import_module(name)\nimport_module('..pages', __package__)")
    assert relative(path) == ["import_module('..pages', __package__)"]


@pytest.mark.parametrize(
    ("test", "run"),
    [
        ("TYPE_CHECKING", {"two"}),
        ("typing.TYPE_CHECKING", {"two"}),
        ("not TYPE_CHECKING", {"one"}),
        ("name or TYPE_CHECKING", {"one", "two"}),
    ],
)
def test_what_is_not_only_for_types_is_run_on_import(
    test: str, run: set[str], tmp_path: Path
) -> None:
    path = tmp_path / "ring.py"
    path.write_text(f"if {test}:\n    import one\nelse:\n    import two")
    assert imported(path) == run


def test_there_are_no_circles_of_modules_nor_of_folders() -> None:
    assert not circles(our_edges())
    between = folders(our_edges())
    assert not circles(between)
    assert {Path(folder).parts[0] for folder in between} == set(ROOMS), "they were read"
    ring = our_edges()["verify.algebra.ring"] | {"verify.proof.order_for_one_h"}
    found = circles(folders(our_edges() | {"verify.algebra.ring": ring}))
    assert any({"algebra", "proof"} <= circle for circle in found)
    planted = our_edges() | {"verify.algebra.differential_ring": {"verify.algebra.ring"}}
    assert any("verify.algebra.differential_ring" in circle for circle in circles(planted))


MOST_FILES = 22


def test_a_folder_can_be_taken_in_at_a_glance() -> None:
    counts = Counter(path.parent for path in MODULES)
    assert max(counts.values()) <= MOST_FILES, counts.most_common(3)


CONTENT = ("reports", "reference")
EXAMPLES = ROOT / "reference" / "examples"  # whole programs for users, of no use to us


def stray(paths: Iterable[Path]) -> list[Path]:
    """The Python files among the content that are no example programs."""
    return [path for path in paths if path.suffix == ".py" and path.parent != EXAMPLES]


def from_content(names: Set[str]) -> set[str]:
    """The modules among those imported that lie in the content: in a checkout, and in a wheel."""
    folders = (*CONTENT, "verify.data")
    return {name for name in names if f"{name}.".startswith(tuple(f"{x}." for x in folders))}


def test_content_holds_no_python_but_example_programs_which_nothing_imports() -> None:
    paths = [path for name in CONTENT for path in (ROOT / name).rglob("*")]
    assert not stray(paths)
    assert any(path.suffix == ".py" for path in paths), "there is an example"
    for name, path in NAMES.items():
        assert not from_content(imported(path, everywhere=True)), name
    for path in EXAMPLES.glob("*.py"):
        assert "verify" not in roots(imported(path, everywhere=True)), "it stands for other code"


def test_stray_python_and_an_imported_example_are_seen(tmp_path: Path) -> None:
    for folder in (ROOT / "reports" / "paper", ROOT / "reference", EXAMPLES / "more"):
        assert stray([folder / "new.py", EXAMPLES / "new.py"]) == [folder / "new.py"]
    lines = ["from reference.examples import lie2", "import verify.data.reference.examples.lie2",
             "from verify.data import reference"]  # fmt: skip
    for number, line in enumerate(lines):
        path = tmp_path / f"{number}.py"  # what a file imports is read once
        path.write_text(f"def f():\n    {line}\n")
        assert from_content(imported(path, everywhere=True))
    assert not from_content({"verify.reference.make.data_folder", "verify.content"})


def test_pages_compute_nothing_themselves() -> None:
    heavy = {"mpmath", "gmpy2", "flint"}
    rooms = {"runs", "kernels", "proof"}
    for name, path in NAMES.items():
        if rooms_of(name) == "pages":
            assert not roots(imported(path, everywhere=True)) & heavy, name
            assert not {rooms_of(other) for other in our_edges()[name]} & rooms, name


def test_only_what_is_declared_is_imported() -> None:
    declared = {"click", "flint", "mpmath", "numpy", "pydantic", "rich", "sympy", "gmpy2",
                "llvmlite", "heyoka", "scipy", "galpy", "nodepy", "rebound",
                "desolver", "diffrax", "extensisq", "gala", "jax_md", "pyhamsys", "torchdiffeq",
                "matplotlib", "jinja2", "markupsafe", "hypothesis",
                "distributed", "pandas", "pyarrow", "tqdm", "verify", "xarray"}  # fmt: skip
    for name, path in NAMES.items():
        others = roots(imported(path, everywhere=True)) - set(sys.stdlib_module_names)
        assert others <= declared, name
