"""What code, its comments, pages, scenes and templates name is there: modules, names, paths."""

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.paths import ROOT

KINDS = {".py", ".md", ".toml", ".html", ".js", ".css"}
FOLDERS = ("verify", "reports", "reference", "tests", "docs")
LEFT_OUT = {
    Path(__file__),  # it plants what is not there
    ROOT / "tests" / "mutants" / "README.md",  # made from results on an older source, by a program
}
BUILT = ROOT / "docs" / "_build"  # the manual, where it was built
AUDITS = ROOT / "reports" / "audits"  # which name files of other libraries
FILES = [
    *(p for name in FOLDERS for p in sorted((ROOT / name).rglob("*"))
      if p.suffix in KINDS and not {BUILT, AUDITS} & {*p.parents}),
    *sorted(ROOT.glob("*.md")),
    ROOT / "pyproject.toml",
]  # fmt: skip
DOTTED = re.compile(r"(?<![\w./-])verify(?:\.\w+)+")
PATHS = re.compile(r"(?<![\w./:-])(?:verify|tests|reports|reference|docs)/[\w/.-]*\w")
PATTERN = re.compile(r"[A-Z]{4,}")  # FAMILY/NAME.py stands for any
LINK = re.compile(r"\]\([^)]*\)")
ELSEWHERE = re.compile(r"verify[/.]data\b|docs/_build\b")  # in a wheel; where the manual was built
NO_NAMES = {
    "ARCHITECTURE.md": {"reference/make"},  # in a table of folders of `verify`
    "verify/drawable.py": {"verify.strategies.name"},  # `name` stands for any
}
# The changelog says of what was what it is now: `old` is `new`.
WAS = re.compile(r"`[^`]+`(?= is (?:now )?`)")
HISTORY = re.compile(r"^## (?!Unreleased).*", re.MULTILINE | re.DOTALL)


@cache
def defined(module: str) -> frozenset[str] | None:
    """The names of a module at its top, `Class.attribute` among them; None where there is none."""
    path = ROOT / module.replace(".", "/")
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    if not file.exists():
        return None
    names: set[str] = set()
    for node in top_of(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            inner = node.body if isinstance(node, ast.ClassDef) else []
            names |= {node.name, *(f"{node.name}.{name}" for name in assigned(inner))}
        elif isinstance(node, ast.ImportFrom):
            names |= {alias.asname or alias.name for alias in node.names}
            if module == "verify":  # its public modules: `verify.systems.get`
                for alias in node.names:
                    inner = defined(f"{node.module}.{alias.name}") or ()
                    names |= {f"{alias.name}.{name}" for name in inner}
        names |= set(assigned([node]))
    return frozenset(names)


def top_of(tree: ast.Module) -> Iterator[ast.stmt]:
    """The statements at its top, and those there under an `if`: public names are, for types."""
    for node in tree.body:
        yield from [*node.body, *node.orelse] if isinstance(node, ast.If) else [node]


def assigned(body: list[ast.stmt]) -> Iterator[str]:
    for node in body:
        if isinstance(node, ast.FunctionDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            nodes = [inner for target in targets for inner in ast.walk(target)]
            yield from (inner.id for inner in nodes if isinstance(inner, ast.Name))


@cache
def is_there(name: str) -> bool:
    """Whether it is a module, a name in one, or an attribute of a class in one."""
    parts = name.split(".")
    for k in range(len(parts), 0, -1):
        found = defined(".".join(parts[:k]))
        if found is not None:
            return k == len(parts) or ".".join(parts[k:]) in found
    return False


@cache
def exists(path: str) -> bool:
    return (ROOT / path).exists()


def stale(text: str) -> list[str]:
    names = [name for name in DOTTED.findall(text) if not is_there(without_dunder(name))]
    paths = [path for path in PATHS.findall(text) if not exists(path)]
    return [
        found
        for found in (*names, *paths)
        if not PATTERN.search(found) and not ELSEWHERE.match(found)
    ]


def without_dunder(name: str) -> str:
    """Without what Python itself defines in any module: `verify.__path__`."""
    return re.sub(r"\.__\w+__$", "", name)


def of_today(text: str) -> str:
    """What the changelog says of what there is: no release before, and no old name."""
    return WAS.sub("", HISTORY.sub("", text))


def told(source: str) -> str:
    """The comments and the docstrings of a Python source."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    comments = [token.string for token in tokens if token.type == tokenize.COMMENT]
    values = [n.value for n in ast.walk(ast.parse(source)) if isinstance(n, ast.Expr)]
    texts = [value.value for value in values if isinstance(value, ast.Constant)]
    return "\n".join([*comments, *(text for text in texts if isinstance(text, str))])


def read(path: Path) -> str:
    """What is to be looked at in a file.

    The code of tests plants names and asks for what is not there; a name that is wrong otherwise
    fails when it is run. So where all that a test's file names is there, no comment is looked for.
    """
    text = path.read_text(encoding="utf-8")
    if path.name == "CHANGELOG.md":
        return of_today(text)
    if path.parent == ROOT / "docs":
        return LINK.sub("]", text)  # relative to its folder; test_documentation.py follows it
    of_a_test = path.suffix == ".py" and path.is_relative_to(ROOT / "tests")
    return told(text) if of_a_test and stale(text) else text


def test_what_is_named_is_there() -> None:
    texts = {
        path.relative_to(ROOT).as_posix(): read(path) for path in FILES if path not in LEFT_OUT
    }
    found = {path: set(stale(text)) for path, text in texts.items()}
    assert {path: names for path, names in found.items() if names} == NO_NAMES
    assert sum(len(DOTTED.findall(text)) for text in texts.values()) > 2000, "they were read"
    assert sum(len(PATHS.findall(text)) for text in texts.values()) > 50, "they were read"
    assert {Path(path).suffix for path in texts} == KINDS


@pytest.mark.parametrize("sentence", ["see `{}`", "see {}.", "({})", "# {}: see there", 'x = "{}"'])
def test_a_stale_name_and_a_stale_path_are_seen(sentence: str) -> None:
    for name in ("verify.algebra.ring", "verify.algebra.ring.Ring.decide", "verify/algebra"):
        assert not stale(sentence.format(name))
    wrong = ["verify.algebra.wrong", "verify.algebra.ring.Wrong", "verify.algebra.ring.Ring.wrong",
             "verify.wrong", "verify/wrong.py", "verify/wrong", "tests/unit/test_wrong.py",
             "tests/wrong/test_wrong.py", "reports/wrong.toml", "reference/wrong"]  # fmt: skip
    for name in wrong:
        assert stale(sentence.format(name)) == [name]


def test_of_the_changelog_only_what_it_says_of_today_is_read() -> None:
    said = (
        "## Unreleased\n`verify.old` is `verify.new`, `verify.gone` stays\n## 0.1\n`verify.older`"
    )
    assert stale(of_today(said)) == ["verify.new", "verify.gone"]


def test_of_a_test_its_comments_and_docstrings_are_read() -> None:
    source = (
        '"""See tests/wrong.py."""\nHERE = "verify/new"\n\n\ndef f():\n    pass  # verify.wrong'
    )
    assert stale(told(source)) == ["verify.wrong", "tests/wrong.py"]
