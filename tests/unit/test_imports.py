"""Imports go downwards only, and light commands stay light: read from the source."""

import ast
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Set
from functools import cache
from pathlib import Path

import pytest

from tests.paths import ROOT

VERIFY = ROOT / "verify"
MODULES = sorted(VERIFY.rglob("*.py"))


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


NAMES = {name_of(path): path for path in MODULES}


def at_module_level(tree: ast.Module) -> Iterator[ast.stmt]:
    """Statements that run on import: not in functions, nor under `if TYPE_CHECKING`."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            waiting += node.orelse
            continue
        if isinstance(node, ast.stmt):
            yield node
        waiting += ast.iter_child_nodes(node)


@cache
def imported(path: Path, everywhere: bool = False) -> frozenset[str]:
    """The modules that a file imports: at module level, or everywhere in it."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found: set[str] = set()
    for node in ast.walk(tree) if everywhere else at_module_level(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            assert node.module is not None
            inner = {f"{node.module}.{alias.name}" for alias in node.names}
            modules = inner & set(NAMES)
            # `from verify import x` imports the module x where there is one, else the package.
            found |= modules or {node.module}
    return frozenset(found)


def roots(names: Set[str]) -> set[str]:
    return {name.partition(".")[0] for name in names}


def rooms_of(name: str) -> str:
    """The room of a module; its own name where it stands in none."""
    return name.split(".")[1] if "." in name else name


# From the roof down. A module imports from its own room and from those below it.
ROOF = ("verify", "__main__", "from_type", "testing")
ROOMS = ("commands", "pages", "reference", "exploration", "strategies", "claims", "studies",
         "integrators", "runs", "flows", "kernels", "execution", "scenes", "proof", "schemes",
         "hamiltonians", "algebra", "arithmetic")  # fmt: skip
GROUND = ("content", "discovery", "drawable", "errors", "notebook", "verdict")


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
    return {*imported(path, everywhere=True), *named(path)} & set(NAMES)


@cache
def named(path: Path) -> frozenset[str]:
    """Modules of ours whose dotted names stand in a file as texts, which import_module takes."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    texts = {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant)}
    modules = set(NAMES) - {"verify"}  # whose data are found by this name
    return frozenset(t for t in texts if isinstance(t, str) and t in modules)


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


EDGES = edges_of(NAMES)


def test_every_folder_is_a_room_and_every_room_has_its_floor() -> None:
    assert {rooms_of(name) for name in NAMES} == {*ROOF, *ROOMS, *GROUND}
    assert len(ROOMS) == 18


def test_imports_go_downwards_only() -> None:
    assert not upward(EDGES)
    assert sum(map(len, EDGES.values())) > 1500, "the edges were read"


@pytest.mark.parametrize(
    "line",
    [
        "from verify.studies.plan import plan_scenes",
        "import verify.commands.main",
        "def f():\n    from verify.pages import page",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from verify.runs.run import run",
        "from importlib import import_module\nimport_module('verify.claims.judge')",
        "from verify import testing",
    ],
)
def test_a_planted_upward_import_is_seen(line: str, tmp_path: Path) -> None:
    path = tmp_path / "ring.py"
    path.write_text(line)
    planted = EDGES | {"verify.algebra.ring": edges_of_file(path)}
    assert {a for a, _ in upward(planted)} == {"verify.algebra.ring"}


def test_there_are_no_circles_of_modules_nor_of_folders() -> None:
    assert not circles(EDGES)
    assert not circles(folders(EDGES))
    planted = EDGES | {"verify.algebra.generator": {"verify.algebra.ring"}}
    assert any("verify.algebra.generator" in circle for circle in circles(planted))


MOST_FILES = 22


def test_a_folder_can_be_taken_in_at_a_glance() -> None:
    counts = Counter(path.parent for path in MODULES)
    assert max(counts.values()) <= MOST_FILES, counts.most_common(3)


def test_content_holds_no_python() -> None:
    assert not [p for name in ("reports", "reference") for p in (ROOT / name).rglob("*.py")]


def test_pages_compute_nothing_themselves() -> None:
    heavy = {"numba", "mpmath", "gmpy2", "flint"}
    rooms = {"runs", "kernels", "proof"}
    for name, path in NAMES.items():
        if rooms_of(name) == "pages":
            assert not roots(imported(path, everywhere=True)) & heavy, name
            assert not {rooms_of(other) for other in EDGES[name]} & rooms, name


LIGHT = [
    "verify",
    "verify.commands.main",
    "verify.commands.output",
    "verify.from_type",
    "verify.errors",
    "verify.commands.progress",
    "verify.verdict",
]
SLOW = {"numba", "matplotlib", "numpy", "sympy", "flint", "mpmath", "pydantic", "rich", "jinja2",
        "hypothesis"}  # fmt: skip


@pytest.mark.parametrize("name", LIGHT)
def test_the_command_line_itself_imports_nothing_slow(name: str) -> None:
    seen, waiting = set(), [name]
    while waiting:
        module = waiting.pop()
        if module not in seen and module in NAMES:
            seen.add(module)
            names = imported(NAMES[module])
            assert not roots(names) & SLOW, f"{name} imports {module}, which imports {names}"
            waiting += names


def test_numba_and_matplotlib_are_imported_only_where_they_are_used() -> None:
    for name, path in NAMES.items():
        drawing = name.startswith("verify.pages.figures.") or name == "verify.pages.plotting"
        assert not roots(imported(path)) & {"numba", *(() if drawing else ("matplotlib",))}, name


EXPLORING = {f"verify.exploration.{name}" for name in ("scenes", "explore", "property_checks",
             "gallery", "hunting", "island_search")}  # fmt: skip


def test_hypothesis_waits_for_strategies_and_for_what_explores() -> None:
    """What imports it when it is imported, itself or by what it imports."""
    edges = {name: imported(path) for name, path in NAMES.items()}
    slow = {name for name, names in edges.items() if "hypothesis" in roots(names)}
    while more := {name for name in edges if edges[name] & slow} - slow:
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
    edges = {name: imported(path) for name, path in NAMES.items()}
    assert not bring_arrays(edges)
    light = {"commands", "execution", "scenes", "claims", "proof", "schemes"}
    assert not {name for name in of_arrays(edges) if rooms_of(name) in light}
    assert "verify.studies.regions.panels" in of_arrays(edges), "the rule speaks of something"
    planted = edges | {
        "verify.studies.plan": edges["verify.studies.plan"] | {"verify.studies.regions.panels"}
    }
    assert bring_arrays(planted) == {("verify.studies.plan", "verify.studies.regions.panels")}


SAID = """
import sys
from verify.commands.main import main
try:
    main({arguments})
except SystemExit as done:
    assert not done.code, done.code
print(sorted({{"numpy", "numba", "matplotlib"}} & set(sys.modules)), file=sys.stderr)
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


@pytest.mark.parametrize(
    ("arguments", "loaded"),
    [
        (["plan", "SCENE"], []),
        (["prove", "--system", "duffing", "--scheme", "lie2"], []),
        (["flow", "SCENE", "--workers", "1"], ["numba", "numpy"]),
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


def test_only_what_is_declared_is_imported() -> None:
    declared = {"click", "flint", "mpmath", "numba", "numpy", "pydantic", "rich", "sympy", "gmpy2",
                "llvmlite", "heyoka", "scipy", "galpy", "nodepy", "rebound",
                "matplotlib", "jinja2", "markupsafe", "hypothesis",
                "distributed", "pyarrow", "verify"}  # fmt: skip
    for name, path in NAMES.items():
        others = roots(imported(path, everywhere=True)) - set(sys.stdlib_module_names)
        assert others <= declared, name
