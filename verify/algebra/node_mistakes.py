"""Messages about syntax of Python that no formula has: functions, comparisons, indices, lists."""

import ast
import re
from collections.abc import Collection

from verify.errors import find_nearest, format_suggestion
from verify.functions import by_name

_MAX_QUOTED_LENGTH = 40  # characters; longer texts are cut in messages
_CASES = "a formula has no cases, since H must be smooth"
# Functions that formulas express by others; {0} and {1} are the arguments, in parentheses.
_BY_FUNCTIONS = {
    "sec": "(1/cos{0})", "csc": "(1/sin{0})", "cosec": "(1/sin{0})", "cot": "(1/tan{0})",
    "ctg": "(1/tan{0})", "sech": "(1/cosh{0})", "csch": "(1/sinh{0})", "coth": "(1/tanh{0})",
    "log10": "(log{0}/log(10))", "log2": "(log{0}/log(2))", "log1p": "log(1 + {0})",
    "expm1": "(exp{0} - 1)", "square": "({0}**2)", "cbrt": "({0}**(1/3))", "pow": "({0}**{1})",
    "power": "({0}**{1})", "hypot": "sqrt({0}**2 + {1}**2)", "asin": "atan({0}/sqrt(1 - {0}**2))",
    "acos": "(pi/2 - atan({0}/sqrt(1 - {0}**2)))", "acosh": "log({0} + sqrt({0}**2 - 1))",
    "atanh": "(log((1 + {0})/(1 - {0}))/2)",
}  # fmt: skip
_REPLACEMENTS = {
    **{name: form for name, form in _BY_FUNCTIONS.items() if name not in by_name()},
    **{other: f"{name}{{0}}" for name, f in by_name().items() for other in f.synonyms},
    "log": "(log{0}/log{1})",  # log(x, base)
}
_WITH_CASES = frozenset({"heaviside", "step", "relu", "piecewise", "where", "clip", "mod", "fmod"})
_VARIABLES = frozenset({"p", "q", "h", "t", "pi"})


def not_allowed(node: ast.expr, line: str, functions: Collection[str]) -> str:
    """Describe an expression of Python that no formula has."""
    source = _source(node, line)
    match node:
        case ast.Tuple(elts=[]):
            more = "something is missing between ( )"
        case ast.Tuple():
            more = "write a decimal with a point, as 0.5, and one formula"
        case ast.Attribute():
            more = "a name has no point; write letters, digits and _"
        case ast.Compare() | ast.IfExp() | ast.BoolOp():
            more = _CASES
        case ast.Subscript(value=ast.Name(id=name)) if name in functions:
            more = f"write {name}({_source(node.slice, line)})"
        case ast.Subscript(value=ast.Name(id="p" | "q" as name)):
            more = f"one degree of freedom is covered; write {name}"
        case ast.Set() | ast.List():
            more = "write ( ) for brackets"
        case _:
            more = "allowed: + - * / ** and functions"
    return f"{source!r} is not allowed; {more}"


def operator_not_allowed(node: ast.BinOp) -> str:
    """Describe an operator of Python that no formula has."""
    more = {
        ast.FloorDiv: "write / for a quotient; // rounds, and a formula has no comment",
        ast.Mod: "% is a remainder, which is not smooth; allowed: + - * / **",
        ast.MatMult: "write * for a product",
        ast.BitAnd: "write * for a product",
    }.get(type(node.op), "allowed: + - * / **")
    return f"an operator is not allowed; {more}"


def stop_of(node: ast.expr, line: str) -> int:
    """Return the offset in the line of the part that is not allowed: a comma, an operator, or the
    node itself."""
    match node:
        case ast.Tuple(elts=[first, *_]):
            return line.find(",", first.end_col_offset)
        case ast.BinOp(left=left, op=ast.FloorDiv() | ast.Mod() | ast.MatMult() | ast.BitAnd()):
            after = re.compile(r"[%/@&]").search(line, left.end_col_offset or 0)
            return after.start() if after else node.col_offset
    return node.col_offset


def unknown_function(node: ast.Call, line: str, functions: Collection[str]) -> str:
    """Describe a call of a name that is no function of formulas, and say what to write."""
    callee = _source(node.func, line)
    inside = ", ".join(_source(each, line) for each in node.args)
    listed = f"allowed: {', '.join(sorted(functions))}"
    name = callee.rpartition(".")[2]
    if not isinstance(node.func, ast.Name | ast.Attribute) or callee in _VARIABLES:
        first = callee if callee.isalnum() else f"({callee})"
        return f"{first} is no function; write {first}*({inside}) for a product"
    meant = name.lower().replace("arc", "a")
    # Capital letters, a module's name as in np.sin, and arc- for a- are the common misspellings.
    if meant in functions and meant != callee.lower():
        more = f"write {meant}({inside})"
    elif meant in _REPLACEMENTS:
        more = f"write {_write_instead(meant, node, line)}"
    elif name.lower() in _WITH_CASES:
        more = f"{_CASES}; {listed}"
    else:
        more = format_suggestion(find_nearest(name.lower(), sorted(functions))) + listed
    return f"unknown function {callee!r}; {more}"


def wrong_arguments(name: str, node: ast.Call, line: str) -> str:
    """Describe a call of an allowed function that has not exactly one argument."""
    has_form = name in _REPLACEMENTS and len(node.args) > 1
    write = _write_instead(name, node, line) if has_form else f"{name}(q)"
    return f"{name} takes one argument; write {write}"


def _write_instead(name: str, node: ast.Call, line: str) -> str:
    form = _REPLACEMENTS[name]
    arguments = [f"({_source(each, line)})" for each in node.args]
    text = form.format(*arguments, "(…)", "(…)")
    # A name or a number needs no parentheses, unless they are those of a function's argument.
    return re.sub(r"(?<![A-Za-z0-9_])\((\w+)\)", r"\1", text)


def reserved_name(name: str, functions: Collection[str]) -> str:
    """Describe a reserved name that stands where a parameter may."""
    if name in functions:
        return f"{name!r} is a function; write {name}(q), and {name}(q)**2 for its square"
    if name == "h":
        return "'h' stands for something else here: the step size; write another name"
    return f"{name!r} stands for something else here; write a finite number or another name"


def unknown_name(name: str, names: Collection[str], functions: Collection[str]) -> str:
    """Describe a name that is not allowed, and list the allowed ones."""
    listed = f"allowed: {', '.join(sorted(names)) or 'numbers alone'}"
    if name in functions:
        example = "q" if names else "2"
        return f"unknown name {name!r}; it is a function: write {name}({example}); {listed}"
    meant = format_suggestion(find_nearest(name, sorted(names)))
    return f"unknown name {name[:_MAX_QUOTED_LENGTH]!r}; {meant}{listed}"


def no_number(value: object, text: str) -> str:
    """Describe a constant of Python that is no number of a formula."""
    more = {
        str: "leave out the quotation marks",
        complex: "H is real; there is no imaginary unit",
        bool: "write 1 or 0",
    }.get(type(value), "allowed: 0.001, 1e-3, 7/3")
    return f"{text[:_MAX_QUOTED_LENGTH]!r} is not a number; {more}"


def exponent_with_names(base: str, exponent: str) -> str:
    """Describe a power whose exponent is no number."""
    if base in ("e", "E"):
        return (
            f"exponent {exponent} must be a rational number; write exp({exponent}) for a power of e"
        )
    factor = f"({exponent})" if re.search(r"[+ -]", exponent) else exponent
    write = f"write a number, or exp({factor}*log({base}))"
    return f"exponent {exponent} must be a rational number; {write}"


def _source(node: ast.expr, line: str) -> str:
    text = (ast.get_source_segment(line, node) or type(node).__name__).strip()
    return text if len(text) <= _MAX_QUOTED_LENGTH else f"{text[: _MAX_QUOTED_LENGTH - 1]}…"
