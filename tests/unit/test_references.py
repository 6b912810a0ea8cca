"""What docstrings, comments and Markdown name in backticks is there: modules, names, paths."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.paths import ROOT

PAGES = (
    "README.md",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "reference/README.md",
    "tests/README.md",
)
FILES = [
    *sorted((ROOT / "verify").rglob("*.py")),
    *sorted((ROOT / "tests").rglob("*.py")),
    *(ROOT / page for page in PAGES),
]
DOTTED = re.compile(r"`(verify(?:\.\w+)+)`")
PATHS = re.compile(r"`((?:verify|tests|reports|reference)/[\w/.-]+)`")
PATTERN = re.compile(r"[A-Z]{4,}")  # FAMILY/NAME.py stands for any
ONLY_IN_A_WHEEL = "verify/data"


@cache
def defined(module: str) -> frozenset[str] | None:
    """The names of a module at its top, `Class.attribute` among them; None where there is none."""
    path = ROOT / module.replace(".", "/")
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    if not file.exists():
        return None
    names: set[str] = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            inner = node.body if isinstance(node, ast.ClassDef) else []
            names |= {node.name, *(f"{node.name}.{name}" for name in assigned(inner))}
        elif isinstance(node, ast.ImportFrom):
            names |= {alias.asname or alias.name for alias in node.names}
        names |= set(assigned([node]))
    return frozenset(names)


def assigned(body: list[ast.stmt]) -> Iterator[str]:
    for node in body:
        if isinstance(node, ast.FunctionDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (target.id for target in targets if isinstance(target, ast.Name))


def is_there(name: str) -> bool:
    """Whether it is a module, a name in one, or an attribute of a class in one."""
    parts = name.split(".")
    for k in range(len(parts), 0, -1):
        found = defined(".".join(parts[:k]))
        if found is not None:
            return k == len(parts) or ".".join(parts[k:]) in found
    return False


def stale(text: str) -> list[str]:
    paths = (p for p in PATHS.findall(text) if not PATTERN.search(p) and p != ONLY_IN_A_WHEEL)
    return [
        *(name for name in DOTTED.findall(text) if not is_there(name)),
        *(path for path in paths if not (ROOT / path).exists()),
    ]


def test_what_is_named_is_there() -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in FILES if path != Path(__file__)}
    found = {str(path.relative_to(ROOT)): stale(text) for path, text in texts.items()}
    assert not {path: names for path, names in found.items() if names}
    assert sum(len(DOTTED.findall(text)) for text in texts.values()) > 100, "they were read"


def test_a_stale_name_and_a_stale_path_are_seen() -> None:
    assert not stale(
        "see `verify.algebra.ring`, `verify.algebra.ring.Ring.decide`, `verify/algebra`"
    )
    wrong = ["verify.algebra.wrong", "verify.algebra.ring.Wrong", "verify.algebra.ring.Ring.wrong",
             "verify.wrong", "verify/wrong.py"]  # fmt: skip
    for name in wrong:
        assert stale(f"see `{name}`") == [name]
