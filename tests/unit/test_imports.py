"""Imports go downwards only, and light commands stay light: read from the source."""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Set
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
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


ABOVE = {"reports", "reference", "tests"}


def test_verify_imports_nothing_that_stands_above_it() -> None:
    for name, path in NAMES.items():
        command = re.fullmatch(r"verify\.cli(_[a-z]+)?", name)
        allowed = {"reports", "reference"} if command else set()
        assert not roots(imported(path)) & ABOVE, name
        assert roots(imported(path, everywhere=True)) & ABOVE <= allowed, name


def test_the_reports_compute_nothing_themselves() -> None:
    heavy = {
        "numba",
        "mpmath",
        "gmpy2",
        "flint",
        "verify.runs.run",
        "verify.kernels.kernel",
        "verify.kernels.stepping",
    }
    for path in sorted((ROOT / "reports").rglob("*.py")):
        assert not imported(path, everywhere=True) & heavy, path


def test_no_modules_import_each_other_in_a_circle() -> None:
    edges = {name: imported(path) & set(NAMES) - {name} for name, path in NAMES.items()}
    done: set[str] = set()

    def visit(name: str, above: tuple[str, ...]) -> None:
        assert name not in above, " → ".join([*above[above.index(name) :], name])
        if name not in done:
            for other in sorted(edges[name]):
                visit(other, (*above, name))
            done.add(name)

    for name in edges:
        visit(name, ())
    assert sum(map(len, edges.values())) > 50, "the edges were read"


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
        assert not roots(imported(path)) & {"numba", "matplotlib"}, name


EXPLORING = {
    "verify.exploration.scenes",
    "verify.exploration.explore",
    "verify.exploration.gallery",
    "verify.exploration.hunting",
}


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
    return {(name, other) for name in set(edges) - arrays for other in edges[name] & arrays}


def test_only_modules_of_arrays_import_modules_of_arrays() -> None:
    """So that what needs no array never imports numpy: the others do so in functions."""
    edges = {name: imported(path) for name, path in NAMES.items()}
    assert not bring_arrays(edges)
    light = {"scene", "plan", "perform", "execute", "report", "tasks", "results", "cli"}
    light |= {
        name.removeprefix("verify.") for name in NAMES if name.startswith("verify.commands.main")
    }
    assert not of_arrays(edges) & {f"verify.{name}" for name in light}
    assert "verify.studies.regions.panels" in of_arrays(edges), "the rule speaks of something"
    planted = edges | {
        "verify.studies.plan": edges["verify.studies.plan"] | {"verify.studies.regions.panels"}
    }
    assert bring_arrays(planted) == {("verify.studies.plan", "verify.studies.regions.panels")}


SAID = """
import sys
from verify.cli import main
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
                "distributed",
                "verify", "reports", "reference"}  # fmt: skip
    for name, path in NAMES.items():
        others = roots(imported(path, everywhere=True)) - set(sys.stdlib_module_names)
        assert others <= declared, name
