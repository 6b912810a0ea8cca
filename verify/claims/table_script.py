"""A program of a few lines that computes a printed table anew, with nothing of this toolkit."""

from collections.abc import Sequence
from fractions import Fraction

import sympy
from sympy.printing.pycode import PythonCodePrinter

from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.schemes import get
from verify.schemes.export.program import program_of

# What is added up in each step, and the number that is printed at the end.
_SUMS = {
    "lg_mse": ("d*d", "math.log10(total/steps)"),
    "mse": ("d*d", "total/steps"),
    "lambda": ("math.log1p(d)", "math.expm1(total)"),
    "lg_abs_lambda": ("math.log1p(d)", "math.log10(abs(math.expm1(total)))"),
}


def table_script(
    hamiltonian: Hamiltonian,
    scheme: str,
    quantity: str,
    starts: Sequence[tuple[Fraction, Fraction]],
    sizes: Sequence[tuple[Fraction, int]],
) -> str:
    """Return a Python program that prints the table in doubles, a row for each start.

    `starts`: (q, p); `sizes`: step sizes, each with its number of steps. Returns "" for a map that
    has no closed form in the plane, or whose H depends on time or on parameters without a value.
    """
    if not hamiltonian.planar or hamiltonian.time_dependent or hamiltonian.symbols:
        return ""
    try:
        program = program_of(get(scheme).step_map(hamiltonian), scheme)
    except InputError:  # such as a map that is given by equations
        return ""
    if program.delta_j is None or len(program.parts) != 1:
        return ""
    names = (sympy.Symbol(f"x{k}", real=True) for k in range(10**6))
    common, values = sympy.cse([*program.parts[0], program.delta_j], names, order="none")
    printer = PythonCodePrinter({"fully_qualified_modules": True})
    term, number = _SUMS[quantity]
    # A scheme may be written in several lines, of which a comment takes only one.
    name = " ".join(scheme.split())
    return "\n".join([
        f"# {quantity.replace('_', ' ')} of {name} for H = {program.hamiltonian}, in doubles",
        "import math",
        "def step(p, q, h):  # returns p, q after it, and det J - 1",
        *(f"    {name} = {printer.doprint(x)}" for name, x in common),
        f"    return {', '.join(map(printer.doprint, values))}",
        f"for q0, p0 in [{_pairs(starts)}]:",
        "    row = []",
        f"    for h, steps in [{_pairs(sizes)}]:",
        "        p, q, total = p0, q0, 0.0",
        "        for _ in range(steps):",
        "            p, q, d = step(p, q, h)",
        f"            total += {term}",
        f"        row.append({number})",
        '    print(f"q = {q0}, p = {p0}:", *(f"{x:.5g}" for x in row))',
    ]) + "\n"  # fmt: skip


def _pairs(pairs: Sequence[tuple[Fraction, Fraction | int]]) -> str:
    return ", ".join(f"({_number(x)}, {_number(y)})" for x, y in pairs)


def _number(x: Fraction | int) -> str:
    """Return a literal; of a fraction that is no short decimal a quotient."""
    whole = int(x)
    return str(whole) if whole == x else repr(float(x)) if Fraction(repr(float(x))) == x else str(x)
