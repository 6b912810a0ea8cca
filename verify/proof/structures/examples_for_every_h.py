"""Hamiltonians whose flow keeps a structure that a scheme does not: examples that refute.

The flow of H = I keeps I, and so does that of each function of I, also if it depends on t. In more
degrees of freedom further examples are invariant under turns, or under moves along q1 + q2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from verify.algebra.expressions.formula_text import to_text
from verify.algebra.formula import symbol
from verify.effort import MAX_CALLS, answer_unless_long
from verify.errors import InputError
from verify.hamiltonians.canonical_field import canonical_field
from verify.hamiltonians.coordinates import coordinates_in
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.lazy_sympy import sympy
from verify.proof.expansion import Leading
from verify.proof.order_for_every_h import MIXED_EXAMPLES, SEPARABLE_EXAMPLES
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.structures.structure_leading import leading_of_structure
from verify.proof.structures.structure_order import check_structure
from verify.schemes import get
from verify.structures import Structure
from verify.structures.first_integral import FirstIntegral
from verify.structures.reversible import Reversible

_EVEN = "p**2/2 + p**2*q + q**2/2 + q**3/3"  # not separable, and even in p
_IN_TIME = "(1 + t)*p**2/2 + p**3/3 + q**2/2 + q**3/3 + t**2*q"
_OF_LOGARITHMS = "log(p) + log(q)"  # its flow keeps p*q, and neither of its parts does


@dataclass(frozen=True)
class Example:
    """An H whose flow keeps the structure, and the leading coefficient of the step's defect."""

    hamiltonian: Hamiltonian
    structure: Structure
    component: str
    leading: Leading


def find_example(
    blank: ProofForEveryH,
    structure: Structure,
    read: Callable[[Hamiltonian], Structure],
    least: int,
) -> Example | None:
    """Return an H for which the structure's defect is not 0; None if none is found.

    `read(H)`: the structure for this H, which for energy is another each time. Of several examples
    it is the one whose defect begins with the lowest power; none is below h^`least`.
    """
    best: Example | None = None
    for text in _formulas(structure, blank.degrees, blank.timed):
        example = _example(blank, text, read)
        if example and (best is None or _power(example) < _power(best)):
            best = example
        if best and _power(best) <= least:
            break
    return best


def _power(example: Example) -> int:
    return example.leading.power or 0


def _example(
    blank: ProofForEveryH, text: str, read: Callable[[Hamiltonian], Structure]
) -> Example | None:
    """Return the example of this H; None if it is of another class, or shows no defect."""
    scheme = get(blank.scheme)
    try:
        hamiltonian = Hamiltonian.parse(text)
        if hamiltonian.degrees != blank.degrees:
            return None
        if blank.separable and not canonical_field(hamiltonian)[0].separable:
            return None
        step_map, structure = scheme.step_map(hamiltonian), read(hamiltonian)
        if not check_structure(hamiltonian, structure):
            return None
        search = partial(leading_of_structure, step_map, structure, scheme, of_flow=True)
        result = answer_unless_long(search, None, MAX_CALLS)
    except InputError:  # the flow of this H does not keep it, or the scheme does not take H
        return None
    if result is None or result[1].decision.zero is not False or result[1].power is None:
        return None
    return Example(hamiltonian, structure, *result)


def _formulas(structure: Structure, degrees: int, timed: bool) -> Iterator[str]:
    """Yield formulas of H, those first whose defects are likely to be of low order."""
    others = "".join(f" + p{k}**2/2" for k in range(2, degrees + 1))
    in_plane = [*SEPARABLE_EXAMPLES, *MIXED_EXAMPLES, _EVEN, *([_IN_TIME] if timed else [])]
    if isinstance(structure, FirstIntegral) and structure.name != "energy":
        squares = [" + ".join(f"{x}{k}**2" for k in range(1, degrees + 1)) for x in "pq"]
        if degrees > 1:
            yield f"({squares[0]})/2 + ({squares[1]})**2/4"
            yield f"({squares[0]})/2 + (q1 - q2)**4/4"
        integral = to_text(structure.integral)
        bound = {x.name[1:] for x in structure.integral.free_symbols}
        rest = "".join(f" + p{k}**2/2" for k in range(1, degrees + 1) if str(k) not in bound)
        rest = rest if degrees > 1 else ""
        yield from (f"({integral})**2/2 + ({integral})**3/3{rest}", integral + rest)
        if degrees == 1:
            yield _OF_LOGARITHMS
        if timed:
            yield f"exp(t)*({integral}){rest}"
    formulas = [x if degrees == 1 else _in_first(x) + others for x in in_plane]
    yield from formulas
    if isinstance(structure, Reversible):  # G + G∘ρ is invariant under ρ
        for formula in formulas:
            yield _with_turned(formula, structure.reflection, coordinates_in(degrees))


def _with_turned(formula: str, reflection: Sequence[sympy.Expr], names: Sequence[str]) -> str:
    """Return the formula of G + G∘ρ."""
    plain = Hamiltonian.parse(formula).exact
    images = dict(zip(map(symbol, names), reflection, strict=True))
    return to_text(plain + plain.xreplace(images))


def _in_first(formula: str) -> str:
    """Return a formula of p and q as one of p1 and q1."""
    return formula.replace("p", "p1").replace("q", "q1")
