"""Light commands stay light: what a command does not need is not imported."""

import re
import subprocess
import sys
from collections.abc import Mapping, Set
from pathlib import Path

import pytest

from tests.helpers.imports import NAMES, imports, rooms_of, roots
from tests.paths import ROOT

LIGHT = [
    "verify",
    "verify.from_type",
    "verify.errors",
    "verify.verdict",
    *(name for name in NAMES if name.startswith("verify.commands")),
]
SLOW = {"matplotlib", "numpy", "sympy", "flint", "mpmath", "pydantic", "rich", "jinja2",
        "hypothesis"}  # fmt: skip


def loaded_with(name: str, imports: Mapping[str, Set[str]]) -> set[str]:
    """What is imported when a module is: what it imports and its packages, and so on."""
    seen: set[str] = set()
    waiting = [name]
    while waiting:
        module = waiting.pop()
        if module not in seen:
            seen.add(module)
            waiting += {*imports.get(module, ()), module.rpartition(".")[0]} - {""}
    return seen


def test_what_is_to_be_light_is_there() -> None:
    assert set(LIGHT) <= set(NAMES)


@pytest.mark.left_to_ci
@pytest.mark.parametrize("name", LIGHT)
def test_the_command_line_itself_imports_nothing_slow(name: str) -> None:
    found = loaded_with(name, imports())
    assert not {m: imports()[m] for m in found & set(imports()) if roots(imports()[m]) & SLOW}
    assert not roots(found) & SLOW


def test_what_a_package_and_what_is_imported_import_is_seen() -> None:
    for module in ("verify", "verify.commands", "verify.from_type"):
        planted = imports() | {module: imports()[module] | {"numpy.linalg"}}
        assert "numpy" in loaded_with("verify.commands.main", planted), module


def test_matplotlib_is_imported_only_where_it_is_used() -> None:
    for name, names in imports().items():
        drawing = name.startswith(("verify.pages.figures.", "verify.pages.plotting"))
        assert drawing or "matplotlib" not in roots(names), name


EXPLORING = {f"verify.exploration.{name}" for name in ("scenes_of_seed", "exploring", "hunting",
             "island_search")}  # fmt: skip


def test_hypothesis_waits_for_strategies_and_for_what_explores() -> None:
    """What imports it when it is imported, itself or by what it imports."""
    slow = {name for name, names in imports().items() if "hypothesis" in roots(names)}
    while more := {name for name in imports() if imports()[name] & slow} - slow:
        slow |= more
    assert {name for name in slow if not name.startswith("verify.strategies")} == EXPLORING


def of_arrays(edges: Mapping[str, Set[str]]) -> set[str]:
    """The modules that import numpy when they are imported themselves."""
    return {name for name, names in edges.items() if "numpy" in roots(names)}


def bring_arrays(edges: Mapping[str, Set[str]]) -> set[tuple[str, str]]:
    """(module, array module) where the first imports the second, and is none itself."""
    arrays = of_arrays(edges)
    others = {name for name in set(edges) - arrays if rooms_of(name) not in ("pages", "reference")}
    return {(name, other) for name in others for other in edges[name] & arrays}


def test_only_modules_of_arrays_import_modules_of_arrays() -> None:
    """So that what needs no array never imports numpy: the others do so in functions."""
    assert not bring_arrays(imports())
    light = {"commands", "execution", "scenes", "claims", "proof", "schemes"}
    assert not {name for name in of_arrays(imports()) if rooms_of(name) in light}
    assert "verify.studies.regions.panels" in of_arrays(imports()), "the rule speaks of something"
    planted = imports() | {
        "verify.studies.tasks_of_scenes": imports()["verify.studies.tasks_of_scenes"]
        | {"verify.studies.regions.panels"}
    }
    assert bring_arrays(planted) == {
        ("verify.studies.tasks_of_scenes", "verify.studies.regions.panels")
    }


SAID = """
import sys
from verify.commands.main import main
try:
    main({arguments})
except SystemExit as done:
    assert not done.code, done.code
print(sorted({{"numpy", "matplotlib"}} & set(sys.modules)), file=sys.stderr)
"""
FLOW = """
system = "duffing"
parameters = { delta = 1 }
schemes = ["lie2"]
[[flow]]
shape = "circle"
step_size = 0.01
steps = [5]
"""


@pytest.mark.left_to_ci
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("arguments", "loaded"),
    [
        (["plan", "SCENE"], []),
        (["prove", "--system", "duffing", "--scheme", "lie2"], []),
        (["flow", "SCENE", "--workers", "1"], ["numpy"]),
    ],
)
def test_what_carries_no_points_loads_no_numpy(
    arguments: list[str], loaded: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(FLOW)
    arguments = [str(path) if given == "SCENE" else given for given in arguments]
    command = [sys.executable, "-c", SAID.format(arguments=arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    assert done.stderr.splitlines()[-1] == str(loaded)


def test_annotations_import_no_sympy() -> None:
    """A class or a function whose annotations are evaluated would import what is to come late."""
    late = re.compile(r"(: |-> |\[)sympy\.")
    texts = {path: path.read_text("utf-8") for path in sorted((ROOT / "verify").rglob("*.py"))}
    lazy = {p: t for p, t in texts.items() if "from verify.lazy_sympy import sympy" in t}
    assert len(lazy) >= 40
    eager = [p for p, t in lazy.items() if late.search(t) and "import annotations" not in t]
    assert not eager
