"""What a file of ours imports, and how, read from its source."""

import ast
import re
from collections.abc import Iterator, Set
from functools import cache, lru_cache
from pathlib import Path

from tests.paths import ROOT

VERIFY = ROOT / "verify"
MODULES = sorted(VERIFY.rglob("*.py"))


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


NAMES = {name_of(path): path for path in MODULES}


ONLY_FOR_TYPES = ("TYPE_CHECKING", "typing.TYPE_CHECKING")


def may_run(node: ast.If) -> list[ast.stmt]:
    """The statements of an `if` that may run on import."""
    test = ast.unparse(node.test)
    if test in ONLY_FOR_TYPES:
        return node.orelse
    if test.removeprefix("not ") in ONLY_FOR_TYPES:
        return node.body
    return [*node.body, *node.orelse]


def at_module_level(tree: ast.Module) -> Iterator[ast.stmt]:
    """Statements that run on import: not in functions, nor under `if TYPE_CHECKING`."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if isinstance(node, ast.If):
            waiting += may_run(node)
            continue
        if isinstance(node, ast.stmt):
            yield node
        waiting += (x for x in ast.iter_child_nodes(node) if not isinstance(x, ast.expr))


@lru_cache(maxsize=1)
def tree_of(path: Path) -> ast.Module:
    """What stands in a file; the last one read is kept, since several questions are asked of it."""
    return ast.parse(path.read_text(encoding="utf-8"))


@lru_cache(maxsize=1)
def nodes_of(path: Path) -> list[ast.AST]:
    return list(ast.walk(tree_of(path)))


@cache
def import_statements(path: Path) -> list[ast.Import | ast.ImportFrom]:
    """All those of a file; they stand in statements, so that no expression is gone through."""
    found: list[ast.AST] = [tree_of(path)]
    for node in found:
        found += (x for x in ast.iter_child_nodes(node) if not isinstance(x, ast.expr))
    return [node for node in found if isinstance(node, ast.Import | ast.ImportFrom)]


@cache
def imported(path: Path, everywhere: bool = False) -> frozenset[str]:
    """The modules that a file imports: at module level, or everywhere in it."""
    found: set[str] = set()
    for node in import_statements(path) if everywhere else at_module_level(tree_of(path)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            assert node.module is not None
            inner = {f"{node.module}.{alias.name}" for alias in node.names}
            # `from verify import x` imports the module x where there is one, else the package's x.
            found |= inner & set(NAMES)
            if not inner <= set(NAMES):
                found.add(node.module)
    return frozenset(found)


def roots(names: Set[str]) -> set[str]:
    return {name.partition(".")[0] for name in names}


def rooms_of(name: str) -> str:
    """The room of a module; its own name where it stands in none."""
    return name.split(".")[1] if "." in name else name


# Where a text, or a piece of one, may begin with our name: only such a file is gone through.
QUOTED = re.compile(r"""(?:['"}]|\\\n)verify""")


@cache
def texts(path: Path) -> frozenset[str]:
    """The texts in a file that begin with `verify`, and such pieces of those put together; but no
    docstrings."""
    if not QUOTED.search(path.read_text(encoding="utf-8")):
        return frozenset()
    told = {id(node.value) for node in nodes_of(path) if isinstance(node, ast.Expr)}
    nodes = [n for n in nodes_of(path) if isinstance(n, ast.Constant) and id(n) not in told]
    values = (node.value for node in nodes if isinstance(node.value, str))
    return frozenset(value for value in values if value.startswith("verify"))


IMPORTERS = {"import_module", "__import__", "resolve_name", "walk_packages", "run_module",
             "run_path", "spec_from_file_location", "exec_module", "load_module"}  # fmt: skip


NAMED = re.compile(rf"\b(?:exec|eval|modules|builtins|{'|'.join(sorted(IMPORTERS))})\b")


def importer(node: ast.AST) -> str | None:
    """By which a node imports what stands in a text, or takes it where it is imported."""
    match node:
        case ast.Name(id=("exec" | "eval") as name):
            return name
        case (
            ast.Attribute(attr="modules" as name) | ast.alias(name=("modules" | "builtins") as name)
        ):
            return name
        case (
            ast.Name(id=name)
            | ast.Attribute(attr=name)
            | ast.alias(name=name)
            | ast.Constant(value=str(name))
        ) if name in IMPORTERS:
            return name
    return None


@cache
def by_name(path: Path) -> frozenset[str]:
    """What a file uses to import by name."""
    if not NAMED.search(path.read_text(encoding="utf-8")):
        return frozenset()
    return frozenset(name for node in nodes_of(path) if (name := importer(node)))


def relative(path: Path) -> list[str]:
    """Calls of import_module with a package, to which the name is then relative."""
    if not by_name(path):
        return []
    calls = [node for node in nodes_of(path) if isinstance(node, ast.Call)]
    return [
        ast.unparse(call)
        for call in calls
        if importer(call.func) == "import_module" and (len(call.args) != 1 or call.keywords)
    ]


def whole_package(path: Path) -> set[str]:
    """What a file imports so that all of `verify` can be reached by attributes from there."""
    statements = import_statements(path)
    names = {a.name for n in statements if isinstance(n, ast.Import) for a in n.names}
    return {name for name in names if name.partition(".")[0] == "verify"}


@cache
def imports() -> dict[str, frozenset[str]]:
    """What each module of ours imports at module level; read when it is first asked for."""
    return {name: imported(path) for name, path in NAMES.items()}
