"""Python functions of floats, which import only `math`."""

import keyword
from collections.abc import Iterator

from sympy.printing.pycode import PythonCodePrinter

from verify.schemes.export.program import Program

SUFFIX = ".py"
RESERVED = frozenset({*keyword.kwlist, "math", "float"})


def render(program: Program) -> str:
    """Return the whole module."""
    head = [f"# {line}" for line in program.head()]
    constants = [f"{c.name} = {c.literal}  # {c.comment}" for c in program.constants]
    functions = [line for key in program.outputs for line in _function(program, key)]
    between = [""] if constants else []
    return "\n".join([*head, "", "import math", *between, *constants, *functions]) + "\n"


def _function(program: Program, key: str) -> Iterator[str]:
    printer = PythonCodePrinter({"fully_qualified_modules": True})
    name = program.name if key == "step" else f"{program.name}_{key}"
    yield from ("", "", f"def {name}({', '.join(program.arguments)}):")
    for target, x in program.functions[key]:
        yield f"    {target} = {printer.doprint(x)}"
    yield f"    return {', '.join(program.outputs[key])}"
