"""Julia: functions of Float64 numbers, which take other number types too."""

from collections.abc import Iterator

import sympy
from sympy.printing.str import StrPrinter

from verify.schemes.export.program import Program

SUFFIX = ".jl"
_RESERVED_WORDS = """
baremodule begin break catch const continue do else elseif end export false finally for function
global if import let local macro module quote return struct true try using while pi im ans
"""
RESERVED = frozenset(_RESERVED_WORDS.split())


class _JuliaPrinter(StrPrinter):  # type: ignore[misc]
    """A printer of sympy's text form with ^ for powers."""

    def _print_Pow(self, expr: sympy.Expr, rational: bool = False) -> str:  # noqa: N802
        return str(super()._print_Pow(expr, rational)).replace("**", "^")


def render(program: Program) -> str:
    """Return the whole file."""
    head = [f"# {line}" for line in program.head()]
    constants = [f"const {c.name} = {c.literal}  # {c.comment}" for c in program.constants]
    functions = [line for key in program.outputs for line in _function(program, key)]
    return "\n".join([*head, *([""] if constants else []), *constants, *functions]) + "\n"


def _function(program: Program, key: str) -> Iterator[str]:
    printer = _JuliaPrinter()
    name = program.name if key == "step" else f"{program.name}_{key}"
    yield from ("", f"function {name}({', '.join(program.arguments)})")
    for target, x in program.functions[key]:
        yield f"    {target} = {printer.doprint(x)}"
    yield from (f"    return {', '.join(program.outputs[key])}", "end")
