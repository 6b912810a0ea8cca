"""Mutants of a Python module: its syntax tree with one thing in it changed, in every way.

What is not changed, as no computation depends on it: texts (f-strings too), annotations and type
aliases, imports, `assert` and what is raised, `__repr__` and its kin, decorators, patterns, what
stands under `if TYPE_CHECKING`, a `zip`'s `strict`, and at module level the numbers of 100 and
more, which bound an effort: a bound that is off by one is no error that could be seen. Nor, by
their names, those smaller ones that say how often something is tried and how many digits more than
are needed it is tried with. Nor the order of two arguments that commute, what speed alone depends
on, and that what is known is not made again.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from tests.mutants.of_the_field import Change, is_text
from tests.mutants.operators import called, changes_of

ROOT = Path(__file__).parents[2]
_QUIET = {"__repr__", "__str__", "_repr_html_", "_repr_latex_"}
_KEYWORDS = {"strict", "repr", "pipelined", "chunk"}  # of an arithmetic the last two, for speed
_EFFORTS = {
    "_ATTEMPTS", "_BISECTIONS", "_CANCELLED", "_CHECK", "_DOUBLINGS", "_FIRST_ORDERS", "_GUARD",
    "_HALVINGS", "_LOST", "MORE_DIGITS", "_NEWTON", "_PATIENCE", "_POINTS", "_ROOT_GUARD_BITS",
    "_ROUGH", "_SETTLED", "_SHORTEST",
}  # fmt: skip
_LARGE = 100
_SHOWN = 60  # characters of each side of a change


@dataclass(frozen=True)
class Mutant:
    """One change: where it stands, by which operator, and its text (`a + b → a - b`).

    `function` is the first line of the function (with its decorators) that it stands in, the
    outermost one; 0 for what runs when the module is imported.
    """

    module: str
    index: int
    line: int
    column: int
    operator: str
    change: str
    function: int

    @property
    def key(self) -> str:
        """The same in every run on the same source, and no other mutant's."""
        return f"{self.module}:{self.line}:{self.column}:{self.operator} {self.change}"


class _Replace(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> Any:
        return self.new if node is self.old else self.generic_visit(node)


def path_of(module: str) -> Path:
    """The module's file; LookupError where there is none. Imports nothing."""
    plain = ROOT.joinpath(*module.split("."))
    for path in (plain.with_suffix(".py"), plain / "__init__.py"):
        if path.exists():
            return path
    raise LookupError(f"{module} is no module of this project")


def mutants(module: str) -> tuple[Mutant, ...]:
    """All mutants of a module, in the order of its source's syntax tree."""
    return mutants_of(path_of(module).read_text(encoding="utf-8"), module)


@cache
def mutants_of(source: str, module: str = "") -> tuple[Mutant, ...]:
    """The same of a source."""
    found: list[Mutant] = []
    seen: dict[str, int] = {}
    for index, ((word, old, new), function) in enumerate(_changes(ast.parse(source))):
        at = (getattr(old, "lineno", 0), getattr(old, "col_offset", 0))
        if isinstance(old, ast.Slice):
            at = (old.lineno, old.col_offset)
        made = Mutant(module, index, *at, word, _told(old, new), function)
        times = seen[made.key] = seen.get(made.key, 0) + 1
        if times > 1:  # where texts are cut, two changes may read alike
            made = Mutant(module, index, *at, word, f"{made.change} (#{times})", function)
        found.append(made)
    return tuple(found)


def mutated(module: str, index: int) -> ast.Module:
    """The module's tree with its mutant of that index; LookupError where there is none."""
    return mutated_source(path_of(module).read_text(encoding="utf-8"), index)


def mutated_source(source: str, index: int) -> ast.Module:
    """The same of a source."""
    tree = ast.parse(source)
    for k, ((_, old, new), _) in enumerate(_changes(tree)):
        if k == index:
            ast.copy_location(new, old)
            return ast.fix_missing_locations(_Replace(old, new).visit(tree))
    raise LookupError(f"there is no mutant {index}")


def _changes(tree: ast.Module) -> Iterator[tuple[Change, int]]:
    """Every change that is made, once, with the first line of the function that it stands in."""
    seen: dict[int, list[ast.AST]] = {}  # of each node itself, and what took its place
    efforts = {id(n) for n in _bounds_of_effort(tree)}
    for node, function in _reached(tree, 0):
        for word, old, new in changes_of(node):
            others = seen.setdefault(id(old), [old])
            if id(old) in efforts or any(_alike(new, each) for each in others):
                continue
            if _made_again(node, old, new):
                continue
            others.append(new)
            yield (word, old, new), function


def _alike(one: ast.AST, other: ast.AST) -> bool:
    return type(one) is type(other) and ast.dump(one) == ast.dump(other)


def _bounds_of_effort(tree: ast.Module) -> Iterator[ast.AST]:
    for statement in tree.body:
        if isinstance(statement, ast.Assign | ast.AnnAssign):
            named = {n.id for n in ast.walk(statement) if isinstance(n, ast.Name)}
            for node in ast.walk(statement):
                match node:
                    case ast.Constant(int() | float() as value):
                        if abs(value) >= _LARGE or named <= _EFFORTS:
                            yield node


def _made_again(node: ast.AST, old: ast.AST, new: ast.AST) -> bool:
    """Whether the change is that in `if x not in known: known[x] = …` it is made each time."""
    match node:
        case ast.If(ast.Compare(ops=[ast.NotIn()], comparators=[known]) as test, body):
            kept = [t.value for s in body if isinstance(s, ast.Assign) for t in s.targets
                    if isinstance(t, ast.Subscript)]  # fmt: skip
            again = isinstance(new, ast.Constant) and new.value is True
            return old is test and again and ast.dump(known) in {ast.dump(x) for x in kept}
    return False


def _reached(node: ast.AST, function: int) -> Iterator[tuple[ast.AST, int]]:
    """The nodes in which something is computed, parents first."""
    if not _of_types(node):
        yield node, function
    for child in _parts(node):
        inside = function
        if not function and isinstance(child, ast.FunctionDef | ast.Lambda):
            first = getattr(child, "decorator_list", [])
            inside = first[0].lineno if first else child.lineno
        yield from _reached(child, inside)


def _parts(node: ast.AST) -> Iterator[ast.AST]:
    """The parts of a node that may be changed."""
    kept: list[Any]
    match node:
        case ast.Raise() | ast.Assert() | ast.Import() | ast.ImportFrom() | ast.JoinedStr():
            kept = []
        case ast.Expr(ast.Constant()):
            kept = []
        case ast.FunctionDef(name=name) if name in _QUIET:
            kept = []
        case ast.FunctionDef(args=a, body=body) | ast.Lambda(a, body):
            inner = body if isinstance(body, list) else [body]
            kept = [*a.defaults, *a.kw_defaults, *inner]
        case ast.ClassDef(body=body) | ast.ExceptHandler(body=body):
            kept = body
        case ast.AnnAssign(value=value):
            kept = [value]
        case ast.Assign([ast.Name(name)], value) if _is_alias(name, value):
            kept = []
        case ast.If(orelse=orelse) if _of_types(node):
            kept = orelse
        case ast.match_case(guard=guard, body=body):
            kept = [guard, *body]
        case ast.Slice(lower, upper, step):  # its plain ends are moved by an operator of its own
            kept = [x for x in (lower, upper) if not _plain(x)] + [step]
        case ast.Call():
            kept = _parts_of_call(node)
        case _:
            kept = list(ast.iter_child_nodes(node))
    return (x for x in kept if x is not None)


def _parts_of_call(node: ast.Call) -> list[ast.AST]:
    name = called(node)
    if name.endswith("Error"):
        return []
    arguments = list(node.args)
    if name in ("isinstance", "issubclass"):
        arguments = arguments[:1]
    elif name == "cast":
        arguments = arguments[1:]
    return [node.func, *arguments, *(k.value for k in node.keywords if k.arg not in _KEYWORDS)]


def _of_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")


def _plain(bound: ast.expr | None) -> bool:
    match bound:
        case None | ast.Constant() | ast.UnaryOp(ast.USub(), ast.Constant()):
            return True
    return False


def _is_alias(name: str, value: ast.expr) -> bool:
    """Whether an assignment names a type: `Start = tuple[Fraction, Fraction]`, `X = A | None`."""
    if not name.lstrip("_")[:1].isupper() or name.isupper():
        return False
    match value:
        case ast.Subscript(ast.Name() | ast.Attribute()) | ast.BinOp(op=ast.BitOr()):
            return not any(is_text(n) for n in ast.walk(value) if isinstance(n, ast.expr))
    return False


def _told(old: ast.AST, new: ast.AST) -> str:
    if isinstance(new, ast.Pass):
        return f"{_short(ast.unparse(old))} → dropped"
    if isinstance(old, ast.BinOp) and isinstance(new, ast.BinOp):
        return f"{_around(old)} → {_around(new)}"
    return f"{_short(ast.unparse(old))} → {_short(ast.unparse(new))}"


def _around(node: ast.BinOp) -> str:
    """An operation with its operands' ends that stand beside the operator."""
    sign = ast.unparse(ast.BinOp(ast.Name("a"), node.op, ast.Name("b")))[1:-1]
    left, right = (" ".join(ast.unparse(x).split()) for x in (node.left, node.right))
    half = _SHOWN // 2
    left = left if len(left) <= half else f"…{left[1 - half :]}"
    right = right if len(right) <= half else f"{right[: half - 1]}…"
    return f"{left}{sign}{right}"


def _short(text: str) -> str:
    text = " ".join(text.split())
    if len(text) <= _SHOWN:
        return text
    half = _SHOWN // 2
    return f"{text[:half]}…{text[1 - half :]}"
