"""A step map as assignments, for any language: the step, its Jacobian, and ΔJ.

A composition is written part by part, each part at the point where the last one left off: with the
parts' Jacobians J_i and ΔJ_i, J is their product and 1 + ΔJ = Π (1 + ΔJ_i), so that nothing is
expanded and no 1 is subtracted. A map in closed form is one part, with the closed form of its ΔJ.
Subexpressions that occur more than once are named. Numbers are taken out as constants.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy

from verify.algebra.formula import FUNCTIONS
from verify.effort import MOST, limited
from verify.errors import InputError, LimitError
from verify.schemes.export.constants import Constant, Constants
from verify.schemes.step_map import StepMap, Substep, grouped

Lines = tuple[tuple[str, sympy.Expr], ...]  # names with what is assigned to them, in turn
_STATE = ("p", "q")
OUTPUTS = {
    "step": ("p_next", "q_next"),
    "jacobian": ("j_pp", "j_pq", "j_qp", "j_qq"),
    "delta_j": ("delta_j",),
}


@dataclass(frozen=True)
class Program:
    """The map of `scheme` for H, `hamiltonian`, as three functions of p, q, h and `parameters`.

    `variables`: p, q and h, with t, at which the step begins, before h where H depends on it.
    `name` is the step's; `functions` has the lines of `step`, `jacobian` (∂p'/∂p, ∂p'/∂q, ∂q'/∂p,
    ∂q'/∂q) and `delta_j`, which end with assignments to the names in `OUTPUTS`. `parts`: the
    formulas of each part, for people. `area_preserving`: whether ΔJ ≡ 0 is proved.
    """

    name: str
    scheme: str
    hamiltonian: str
    variables: tuple[str, ...]
    parameters: tuple[str, ...]
    constants: tuple[Constant, ...]
    functions: dict[str, Lines]
    parts: tuple[tuple[sympy.Expr, sympy.Expr], ...]
    delta_j: sympy.Expr | None
    area_preserving: bool

    @property
    def arguments(self) -> tuple[str, ...]:
        """The names of what each function takes."""
        return (*self.variables, *self.parameters)

    def head(self) -> tuple[str, ...]:
        """What it is, in lines of a comment, in ASCII."""
        area = "Delta J = det J - 1 is 0: det J = 1 is proved" if self.area_preserving else (
            "delta_j is Delta J = det J - 1, from its own formula"
        )  # fmt: skip
        lines = (
            f"One step of the scheme {self.scheme}",
            f"for H = {self.hamiltonian}, p' = -dH/dq, q' = dH/dp.",
            f"{area}.",
            *(
                ["J is taken at a fixed t, at which the step begins."]
                if "t" in self.variables
                else []
            ),
            "Constants are the doubles nearest to the exact numbers in the comments.",
        )
        return tuple(" ".join(line.split()) for line in lines)  # a text of the users' has ends


def program_of(
    step_map: StepMap, scheme: str, name: str = "step", reserved: Iterable[str] = ()
) -> Program:
    """The map as assignments.

    `name`: what the step is to be called; InputError where it is no name. `reserved`: words that
    no parameter may be called by; one that is gets a `_` behind it. Raises LimitError for a map
    that is given by equations.
    """
    if not (name.isascii() and name.isidentifier()) or name in {*reserved, *FUNCTIONS}:
        raise InputError("name", name, "is no name for a function; allowed: letters, digits, _")
    if step_map.implicit:
        shown = str(step_map.hamiltonian.expression)
        problem = "is given by equations; only a map in closed form is exported"
        raise LimitError("map", shown, problem)
    taken = {*reserved, *(n for names in OUTPUTS.values() for n in names), *OUTPUTS, name}
    renamed = _renamed(step_map.hamiltonian.symbols, taken)
    time = ("t",) if step_map.hamiltonian.time_dependent else ()
    variables = ("p", "q", *time, "h")
    with limited("map", scheme, "to write it out", 10 * MOST):
        writer = _Writer(step_map, renamed, variables)
        functions = {key: getattr(writer, key)() for key in OUTPUTS}
    return Program(
        name=name,
        scheme=scheme,
        hamiltonian=_formula(step_map, renamed),
        variables=variables,
        parameters=tuple(str(x) for x in renamed.values()),
        functions=functions,
        constants=tuple(writer.constants),
        parts=tuple(writer.formulas),
        delta_j=step_map.delta_j.xreplace(renamed) if step_map.has_closed_form else None,
        area_preserving=step_map.preserves_area,
    )


def _formula(step_map: StepMap, renamed: dict[sympy.Symbol, sympy.Symbol]) -> str:
    return str(step_map.hamiltonian.exact.xreplace(renamed))


def _renamed(names: Sequence[str], taken: set[str]) -> dict[sympy.Symbol, sympy.Symbol]:
    """The parameters under names that are free; a name that is taken gets a `_`."""
    found = {}
    for name in names:
        free = name
        while free in taken or (free != name and free in names):
            free += "_"
        found[sympy.Symbol(name, real=True)] = sympy.Symbol(free, real=True)
    return found


class _Writer:
    def __init__(
        self, step_map: StepMap, renamed: dict[sympy.Symbol, sympy.Symbol], variables: Sequence[str]
    ) -> None:
        self.map = step_map
        self.renamed = renamed
        self.used = {*variables, *map(str, renamed.values())}
        self.constants = Constants(lambda k: self._free(f"c{k}"))
        closed = step_map.closed
        self.parts: Sequence[Substep] = step_map.substeps if closed is None else (closed,)
        self.formulas = [
            tuple(grouped(s.ring, x).xreplace(renamed) for x in (s.p_next, s.q_next))
            for s in self.parts
        ]

    def _free(self, name: str) -> str:
        while name in self.used:
            name += "_"
        return name

    def _common(self, before: str, wanted: Sequence[sympy.Expr]) -> tuple[Lines, list[sympy.Expr]]:
        """Names, which begin so, for what occurs more than once; and the expressions with them."""
        exact = [self.constants.taken_out(x) for x in wanted]
        names = (sympy.Symbol(self._free(f"{before}{k}"), real=True) for k in range(10**6))
        found, left = sympy.cse(exact, names, order="none")
        return tuple((str(n), x) for n, x in found), left

    def step(self) -> Lines:
        """p' and q', part by part."""
        lines: list[tuple[str, sympy.Expr]] = []
        for k, pair in enumerate(self.formulas[:-1]):
            lines += self._moved(k, pair, ())[0]
        common, left = self._common("x", self.formulas[-1])
        return (*lines, *common, *zip(OUTPUTS["step"], left, strict=True))

    def _moved(
        self, k: int, pair: Sequence[sympy.Expr], more: Sequence[sympy.Expr]
    ) -> tuple[Lines, list[sympy.Expr]]:
        """p and q set to those after part k; `more` are values at the point before."""
        common, left = self._common(f"x{k}_", [*pair, *more])
        kept, after = self._kept(f"w{k}_", left[2:])
        changed = [x for x in zip(_STATE, left[:2], strict=True) if x[0] != str(x[1])]
        if len(changed) < len(_STATE):
            return (*common, *kept, *changed), after
        names = [self._free(f"{name}{k}_") for name in _STATE]
        ends = zip(_STATE, (sympy.Symbol(name, real=True) for name in names), strict=True)
        return (*common, *kept, *zip(names, left[:2], strict=True), *ends), after

    def _kept(self, before: str, values: Sequence[sympy.Expr]) -> tuple[Lines, list[sympy.Expr]]:
        """Names for values that change with p and q; numbers stay as they are."""
        lines, found = [], []
        for n, x in enumerate(values):
            if not x.is_number:
                lines.append((self._free(f"{before}{n}"), x))
                x = sympy.Symbol(lines[-1][0], real=True)
            found.append(x)
        return tuple(lines), found

    def jacobian(self) -> Lines:
        """The product of the parts' Jacobians."""
        lines: list[tuple[str, sympy.Expr]] = []
        total = sympy.eye(2)
        last = len(self.parts) - 1
        for k, (part, pair) in enumerate(zip(self.parts, self.formulas, strict=True)):
            entries = [grouped(part.ring, x).xreplace(self.renamed) for x in part.jacobian]
            moved, own = self._common("x", entries) if k == last else self._moved(k, pair, entries)
            kept, names = self._kept(f"j{k}_", sympy.Matrix(2, 2, own) * total)
            lines += moved
            if k < last:
                lines += kept
                total = sympy.Matrix(2, 2, names)
            else:
                total = sympy.Matrix(2, 2, own) * total
        return (*lines, *zip(OUTPUTS["jacobian"], total, strict=True))

    def delta_j(self) -> Lines:
        """ΔJ: 0 where that is proved, in closed form where there is one, else by the parts."""
        if self.map.has_closed_form:
            lines, (total,) = self._common("x", [self.map.delta_j.xreplace(self.renamed)])
            return (*lines, ("delta_j", total))
        found: list[tuple[str, sympy.Expr]] = []
        total = sympy.S.Zero
        for k, (part, pair) in enumerate(zip(self.parts, self.formulas, strict=True)):
            own = part.ring.factored(part.delta_j).xreplace(self.renamed)
            moved, (change,) = self._moved(k, pair, [own])
            found += moved
            name = self._free(f"d{k}")
            found.append((name, total + change + total * change))
            total = sympy.Symbol(name, real=True)
        return (*found, ("delta_j", total))
