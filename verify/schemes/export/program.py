"""A step map as assignments, for any language: the step, its Jacobian, and ΔJ.

A composition is written part by part, each part at the point where the last one left off: with the
parts' Jacobians J_i and ΔJ_i, J is their product and 1 + ΔJ = Π (1 + ΔJ_i), so that nothing is
expanded and no 1 is subtracted. A map in closed form is one part, with the closed form of its ΔJ.
Subexpressions that occur more than once are named. Numbers are taken out as constants.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy

from verify.algebra.formula import FUNCTIONS, symbol
from verify.effort import MOST, limited
from verify.errors import InputError, LimitError
from verify.schemes.export.constants import Constant, Constants
from verify.schemes.maps.closed_form import ClosedForm
from verify.schemes.maps.parts import parts_of
from verify.schemes.maps.step_map import StepMap, grouped

_MOST_COORDINATES = 4  # of a map in stages, whose determinant is written out
Lines = tuple[tuple[str, sympy.Expr], ...]  # names with what is assigned to them, in turn


def outputs_of(coordinates: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """What each function gives, by its name.

    >>> outputs_of(("p", "q"))["jacobian"]
    ('j_pp', 'j_pq', 'j_qp', 'j_qq')
    """
    return {
        "step": tuple(f"{x}_next" for x in coordinates),
        "jacobian": tuple(f"j_{x}{y}" for x in coordinates for y in coordinates),
        "delta_j": ("delta_j",),
    }


@dataclass(frozen=True)
class Program:
    """The map of `scheme` for H, `hamiltonian`, as three functions of z, h and `parameters`.

    `variables`: the `coordinates` and h, with t, at which the step begins, before h where H depends
    on it. `name` is the step's; `functions` has the lines of `step`, `jacobian` (∂z'/∂z by rows)
    and `delta_j`, which end with assignments to the names in `outputs`. `parts`: the formulas of
    each part, for people. `area_preserving`: whether ΔJ ≡ 0 is proved.
    """

    name: str
    scheme: str
    hamiltonian: str
    coordinates: tuple[str, ...]
    variables: tuple[str, ...]
    parameters: tuple[str, ...]
    constants: tuple[Constant, ...]
    functions: dict[str, Lines]
    parts: tuple[tuple[sympy.Expr, ...], ...]
    delta_j: sympy.Expr | None
    area_preserving: bool

    @property
    def arguments(self) -> tuple[str, ...]:
        """The names of what each function takes."""
        return (*self.variables, *self.parameters)

    @property
    def outputs(self) -> dict[str, tuple[str, ...]]:
        """What each function gives."""
        return outputs_of(self.coordinates)

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
    coordinates = step_map.hamiltonian.coordinates
    outputs = outputs_of(coordinates)
    taken = {*reserved, *(n for names in outputs.values() for n in names), *outputs, name}
    renamed = _renamed(step_map.hamiltonian.symbols, taken)
    time = ("t",) if step_map.hamiltonian.time_dependent else ()
    variables = (*coordinates, *time, "h")
    with limited("map", scheme, "to write it out", 10 * MOST):
        writer = _Writer(step_map, renamed, variables)
        functions = {key: getattr(writer, key)() for key in outputs}
    return Program(
        name=name,
        scheme=scheme,
        hamiltonian=str(step_map.hamiltonian.exact.xreplace(renamed)),
        coordinates=coordinates,
        variables=variables,
        parameters=tuple(str(x) for x in renamed.values()),
        functions=functions,
        constants=tuple(writer.constants),
        parts=tuple(writer.formulas),
        delta_j=step_map.delta_j.xreplace(renamed) if step_map.has_closed_form else None,
        area_preserving=step_map.preserves_area,
    )


def _renamed(names: Sequence[str], taken: set[str]) -> dict[sympy.Symbol, sympy.Symbol]:
    """The parameters under names that are free; a name that is taken gets a `_`."""
    found = {}
    for name in names:
        free = name
        while free in taken or (free != name and free in names):
            free += "_"
        found[sympy.Symbol(name, real=True)] = sympy.Symbol(free, real=True)
    return found


@dataclass(frozen=True)
class _Part:
    """z' of a part, ∂z'/∂z row by row, and its det − 1."""

    formulas: tuple[sympy.Expr, ...]
    jacobian: tuple[sympy.Expr, ...]
    delta_j: sympy.Expr

    def renamed(self, names: dict[sympy.Symbol, sympy.Symbol]) -> "_Part":
        """With other names for parameters."""
        formulas, jacobian = (
            tuple(x.xreplace(names) for x in row) for row in (self.formulas, self.jacobian)
        )
        return _Part(formulas, jacobian, self.delta_j.xreplace(names))


def _in_ring(part: ClosedForm) -> _Part:
    """A part in closed form, its formulas by powers of h."""
    ring, entries = part.ring, [x for row in part.jacobian for x in row]
    formulas, jacobian = (tuple(grouped(ring, x) for x in y) for y in (part.elements, entries))
    return _Part(formulas, jacobian, ring.factored(part.delta_j))


def _in_stages(step_map: StepMap) -> _Part:
    """A map whose stages stand in one another: what they have in common gets names later."""
    formulas, state = step_map.composed, list(map(symbol, step_map.hamiltonian.coordinates))
    size = len(state)
    if size > _MOST_COORDINATES:
        return _in_ring(step_map.flat)
    jacobian = tuple(x.diff(y) for x in formulas for y in state)
    entries = [x - int(k % (size + 1) == 0) for k, x in enumerate(jacobian)]
    slopes = sympy.Matrix(size, size, sympy.symbols(f"k:{size * size}"))
    change = sympy.expand((sympy.eye(size) + slopes).det(method="berkowitz") - 1)
    put = dict(zip(slopes, entries, strict=True))
    return _Part(formulas, jacobian, change.xreplace(put))


class _Writer:
    def __init__(
        self, step_map: StepMap, renamed: dict[sympy.Symbol, sympy.Symbol], variables: Sequence[str]
    ) -> None:
        self.map = step_map
        self.renamed = renamed
        self.state = step_map.hamiltonian.coordinates
        self.outputs = outputs_of(self.state)
        self.used = {*variables, *map(str, renamed.values())}
        self.constants = Constants(lambda k: self._free(f"c{k}"))
        closed = step_map.closed
        parts = parts_of(step_map) if closed is None else (closed,)
        made = [_in_ring(x) for x in parts] if parts else [_in_stages(step_map)]
        self.parts = [x.renamed(renamed) for x in made]
        self.formulas = [part.formulas for part in self.parts]

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
        return (*lines, *common, *zip(self.outputs["step"], left, strict=True))

    def _moved(
        self, k: int, pair: Sequence[sympy.Expr], more: Sequence[sympy.Expr]
    ) -> tuple[Lines, list[sympy.Expr]]:
        """p and q set to those after part k; `more` are values at the point before."""
        common, left = self._common(f"x{k}_", [*pair, *more])
        size = len(self.state)
        kept, after = self._kept(f"w{k}_", left[size:])
        changed = [x for x in zip(self.state, left[:size], strict=True) if x[0] != str(x[1])]
        if len(changed) < len(self.state) and self._apart(changed):
            return (*common, *kept, *changed), after
        names = [self._free(f"{name}{k}_") for name in self.state]
        ends = zip(self.state, (sympy.Symbol(name, real=True) for name in names), strict=True)
        return (*common, *kept, *zip(names, left[:size], strict=True), *ends), after

    def _apart(self, changed: Sequence[tuple[str, sympy.Expr]]) -> bool:
        """Whether no new value is read by one that is assigned after it."""
        names: set[str] = set()
        for name, x in changed:
            if names & {s.name for s in x.free_symbols}:
                return False
            names.add(name)
        return True

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
        size = len(self.state)
        total = sympy.eye(size)
        last = len(self.parts) - 1
        for k, (part, pair) in enumerate(zip(self.parts, self.formulas, strict=True)):
            entries = part.jacobian
            moved, own = self._common("x", entries) if k == last else self._moved(k, pair, entries)
            kept, names = self._kept(f"j{k}_", sympy.Matrix(size, size, own) * total)
            lines += moved
            if k < last:
                lines += kept
                total = sympy.Matrix(size, size, names)
            else:
                total = sympy.Matrix(size, size, own) * total
        return (*lines, *zip(self.outputs["jacobian"], total, strict=True))

    def delta_j(self) -> Lines:
        """ΔJ: 0 where that is proved, in closed form where there is one, else by the parts."""
        if self.map.has_closed_form:
            lines, (total,) = self._common("x", [self.map.delta_j.xreplace(self.renamed)])
            return (*lines, ("delta_j", total))
        found: list[tuple[str, sympy.Expr]] = []
        total = sympy.S.Zero
        for k, (part, pair) in enumerate(zip(self.parts, self.formulas, strict=True)):
            moved, (change,) = self._moved(k, pair, [part.delta_j])
            found += moved
            name = self._free(f"d{k}")
            found.append((name, total + change + total * change))
            total = sympy.Symbol(name, real=True)
        return (*found, ("delta_j", total))
