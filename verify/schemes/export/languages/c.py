"""C99, which is also C++: three functions and their constants; needs -lm."""

from collections.abc import Sequence

import sympy
from sympy.printing.c import C99CodePrinter

from verify.schemes.export.program import Program

SUFFIX = ".c"
_RESERVED_WORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int
long register restrict return short signed sizeof static struct switch typedef union unsigned void
volatile while bool true false main out j0 j1 jn y0 y1 yn gamma class namespace new delete this
template operator public private protected friend virtual try catch throw using
"""  # words of C and C++, and names of math.h
RESERVED = frozenset(_RESERVED_WORDS.split())


class _Printer(C99CodePrinter):  # type: ignore[misc]
    """A printer that writes all numbers as doubles, and small powers as products."""

    def _print_Pow(self, expr: sympy.Expr) -> str:  # noqa: N802 - sympy's naming
        base = self.parenthesize(expr.base, sympy.printing.precedence.PRECEDENCE["Pow"])
        # Small powers are written as products, which avoids calls of pow.
        if expr.exp.is_Integer and expr.base.is_Symbol and 2 <= int(expr.exp) <= 4:
            return f"({'*'.join([base] * int(expr.exp))})"
        return str(super()._print_Pow(expr))

    def _print_Integer(self, expr: sympy.Expr) -> str:  # noqa: N802
        return f"{int(expr)}.0"


def render(program: Program) -> str:
    """Return the whole file."""
    lines = [*(f"// {line}" for line in program.head()), "", "#include <math.h>", ""]
    lines += [
        f"static const double {c.name} = {c.literal};  // {c.comment}" for c in program.constants
    ]
    for key in program.outputs:
        lines += ["", *_function(program, key)]
    return "\n".join(lines) + "\n"


def _function(program: Program, key: str) -> list[str]:
    statements, outputs = program.functions[key], program.outputs[key]
    arguments = ", ".join(f"double {name}" for name in program.arguments)
    name = program.name if key == "step" else f"{program.name}_{key}"
    printer, declared = _Printer(), set(program.arguments)
    body = []
    for target, x in statements:
        value = printer.doprint(x)
        if key != "delta_j" and target in outputs:
            body.append(f"    out[{outputs.index(target)}] = {value};")
        elif target in outputs:
            body.append(f"    return {value};")
        else:
            body.append(f"    {'' if target in declared else 'double '}{target} = {value};")
            declared.add(target)
    unused = [n for n in program.arguments if not any(_uses(x, n) for _, x in statements)]
    body = [*(f"    (void){n};" for n in unused), *body]
    if key == "delta_j":
        return [f"double {name}({arguments})", "{", *body, "}"]
    return [
        f"// {_end(program.coordinates, key)}",
        f"void {name}({arguments}, double *out)",
        "{",
        *body,
        "}",
    ]


def _end(names: Sequence[str], key: str) -> str:
    """Describe the values that a function writes into `out`."""
    entries = [f"{x}'" for x in names]
    if key == "jacobian":
        entries = [f"d{x}'/d{y}" for x in names for y in names]
    return f"out[{len(entries)}]: {', '.join(entries)}"


def _uses(x: sympy.Expr, name: str) -> bool:
    return any(s.name == name for s in x.free_symbols)
