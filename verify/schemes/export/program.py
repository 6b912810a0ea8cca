"""A step map as assignments, for any language: the step, its Jacobian, and ΔJ.

A composition is written part by part, each part at the point where the one before it ends. With the
parts' Jacobians J_i and ΔJ_i = det J_i − 1, J is the product of the J_i and 1 + ΔJ = Π (1 + ΔJ_i);
nothing is expanded, and no 1 is subtracted from the product. A map in closed form is one part, with
the closed form of its ΔJ. Subexpressions that occur more than once get names. Numbers become
constants.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy

from verify.algebra.formula import FUNCTIONS, symbol
from verify.effort import MAX_CALLS, limit_effort
from verify.errors import InputError, LimitError
from verify.schemes.export.constants import Constant, Constants
from verify.schemes.maps.closed_form import ClosedForm, group_by_powers
from verify.schemes.maps.parts import parts_of
from verify.schemes.maps.step_map import StepMap

_MOST_COORDINATES = 4  # limit for writing out the determinant of a map in stages
Lines = tuple[tuple[str, sympy.Expr], ...]  # names and the expressions assigned to them, in order


def outputs_of(coordinates: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return the outputs of each function, by its name.

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

    `variables`: the coordinates, the time t at which the step begins if H depends on it, and h.
    `name`: the name of the step's function. `functions`: the lines of `step`, of `jacobian` (∂z'/∂z
    by rows) and of `delta_j`; each ends with assignments to the names in `outputs`. `parts`: the
    formulas of each part, for readers. `area_preserving`: True if ΔJ ≡ 0 is proved.
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
        """The names of the arguments of each function."""
        return (*self.variables, *self.parameters)

    @property
    def outputs(self) -> dict[str, tuple[str, ...]]:
        """The names of the outputs of each function."""
        return outputs_of(self.coordinates)

    def head(self) -> tuple[str, ...]:
        """Return a description of the program, in lines of a comment, in ASCII."""
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
        return tuple(" ".join(line.split()) for line in lines)  # a user's text may have line ends


def program_of(
    step_map: StepMap, scheme: str, name: str = "step", reserved: Iterable[str] = ()
) -> Program:
    """Return the map as assignments.

    `name`: the name of the step function. `reserved`: words that cannot be names; a `_` is appended
    to a parameter with such a name. Raises InputError if `name` cannot be one, and LimitError for a
    map that is defined by equations.
    """
    if not (name.isascii() and name.isidentifier()) or name in {*reserved, *FUNCTIONS}:
        raise InputError("name", name, "is no name for a function; allowed: letters, digits, _")
    if step_map.implicit:
        formula = str(step_map.hamiltonian.expression)
        problem = "is given by equations; only a map in closed form is exported"
        raise LimitError("map", formula, problem)
    coordinates = step_map.hamiltonian.coordinates
    outputs = outputs_of(coordinates)
    reserved_names = {*reserved, *(n for names in outputs.values() for n in names), *outputs, name}
    renaming = _free_symbols(step_map.hamiltonian.symbols, reserved_names)
    time = ("t",) if step_map.hamiltonian.time_dependent else ()
    variables = (*coordinates, *time, "h")
    with limit_effort("map", scheme, "to write it out", 10 * MAX_CALLS):
        writer = _Writer(step_map, renaming, variables)
        functions = {key: getattr(writer, key)() for key in outputs}
    return Program(
        name=name,
        scheme=scheme,
        hamiltonian=str(step_map.hamiltonian.exact.xreplace(renaming)),
        coordinates=coordinates,
        variables=variables,
        parameters=tuple(str(x) for x in renaming.values()),
        functions=functions,
        constants=tuple(writer.constants),
        parts=tuple(writer.formulas),
        delta_j=step_map.delta_j.xreplace(renaming) if step_map.has_closed_form else None,
        area_preserving=step_map.preserves_area,
    )


def _free_symbols(
    names: Sequence[str], reserved_names: set[str]
) -> dict[sympy.Symbol, sympy.Symbol]:
    """Return the parameters with free names: `_` is appended to a name that is taken."""
    symbols = {}
    for name in names:
        free = name
        while free in reserved_names or (free != name and free in names):
            free += "_"
        symbols[sympy.Symbol(name, real=True)] = sympy.Symbol(free, real=True)
    return symbols


@dataclass(frozen=True)
class _Part:
    """The formulas z' of a part, its Jacobian ∂z'/∂z row by row, and its ΔJ."""

    formulas: tuple[sympy.Expr, ...]
    jacobian: tuple[sympy.Expr, ...]
    delta_j: sympy.Expr

    def with_names(self, names: dict[sympy.Symbol, sympy.Symbol]) -> "_Part":
        """Return the part with other names for parameters."""
        formulas, jacobian = (
            tuple(x.xreplace(names) for x in row) for row in (self.formulas, self.jacobian)
        )
        return _Part(formulas, jacobian, self.delta_j.xreplace(names))


def _in_ring(part: ClosedForm) -> _Part:
    """Return a part given in closed form, its formulas grouped by powers of h."""
    ring, entries = part.ring, [x for row in part.jacobian for x in row]
    formulas, jacobian = (
        tuple(group_by_powers(ring, x) for x in y) for y in (part.elements, entries)
    )
    return _Part(formulas, jacobian, ring.as_product(part.delta_j))


def _in_stages(step_map: StepMap) -> _Part:
    """Return a map in nested stages as one part; common subexpressions get names later."""
    formulas, state = step_map.composed, list(map(symbol, step_map.hamiltonian.coordinates))
    size = len(state)
    if size > _MOST_COORDINATES:
        return _in_ring(step_map.flat)
    jacobian = tuple(x.diff(y) for x in formulas for y in state)
    entries = [x - int(k % (size + 1) == 0) for k, x in enumerate(jacobian)]
    # det(1 + K) − 1 is expanded with symbols for the entries of K = J − 1: the 1 cancels exactly.
    slopes = sympy.Matrix(size, size, sympy.symbols(f"k:{size * size}"))
    change = sympy.expand((sympy.eye(size) + slopes).det(method="berkowitz") - 1)
    substitutions = dict(zip(slopes, entries, strict=True))
    return _Part(formulas, jacobian, change.xreplace(substitutions))


class _Writer:
    def __init__(
        self,
        step_map: StepMap,
        renaming: dict[sympy.Symbol, sympy.Symbol],
        variables: Sequence[str],
    ) -> None:
        self.map = step_map
        self.renaming = renaming
        self.state = step_map.hamiltonian.coordinates
        self.outputs = outputs_of(self.state)
        self.used_names = {*variables, *map(str, renaming.values())}
        self.constants = Constants(lambda k: self._free(f"c{k}"))
        closed_form = step_map.closed
        parts = parts_of(step_map) if closed_form is None else (closed_form,)
        unnamed_parts = [_in_ring(x) for x in parts] if parts else [_in_stages(step_map)]
        self.parts = [x.with_names(renaming) for x in unnamed_parts]
        self.formulas = [part.formulas for part in self.parts]

    def _free(self, name: str) -> str:
        while name in self.used_names:
            name += "_"
        return name

    def _common(
        self, before: str, expressions: Sequence[sympy.Expr]
    ) -> tuple[Lines, list[sympy.Expr]]:
        """Return the lines that name repeated subexpressions, and the expressions in these names.

        `before`: the beginning of the names.
        """
        exact = [self.constants.extract(x) for x in expressions]
        names = (sympy.Symbol(self._free(f"{before}{k}"), real=True) for k in range(10**6))
        common, reduced = sympy.cse(exact, names, order="none")
        return tuple((str(n), x) for n, x in common), reduced

    def step(self) -> Lines:
        """Return the lines of p' and q', part by part."""
        lines: list[tuple[str, sympy.Expr]] = []
        for k, pair in enumerate(self.formulas[:-1]):
            lines += self._move_state(k, pair, ())[0]
        common, reduced = self._common("x", self.formulas[-1])
        return (*lines, *common, *zip(self.outputs["step"], reduced, strict=True))

    def _move_state(
        self, k: int, pair: Sequence[sympy.Expr], more: Sequence[sympy.Expr]
    ) -> tuple[Lines, list[sympy.Expr]]:
        """Return the lines that move the state by part k, and the values of `more` before it."""
        common, reduced = self._common(f"x{k}_", [*pair, *more])
        size = len(self.state)
        value_lines, after = self._name_values(f"w{k}_", reduced[size:])
        changes = [x for x in zip(self.state, reduced[:size], strict=True) if x[0] != str(x[1])]
        # A shear changes only p or only q, and can be assigned in place without temporaries.
        if len(changes) < len(self.state) and self._can_assign_in_turn(changes):
            return (*common, *value_lines, *changes), after
        names = [self._free(f"{name}{k}_") for name in self.state]
        ends = zip(self.state, (sympy.Symbol(name, real=True) for name in names), strict=True)
        return (*common, *value_lines, *zip(names, reduced[:size], strict=True), *ends), after

    def _can_assign_in_turn(self, changes: Sequence[tuple[str, sympy.Expr]]) -> bool:
        """Return True if no assignment reads a value that an earlier one has changed."""
        names: set[str] = set()
        for name, x in changes:
            if names & {s.name for s in x.free_symbols}:
                return False
            names.add(name)
        return True

    def _name_values(
        self, before: str, values: Sequence[sympy.Expr]
    ) -> tuple[Lines, list[sympy.Expr]]:
        """Return lines that name values, and the names; a number stays as it is."""
        lines, results = [], []
        for n, x in enumerate(values):
            if not x.is_number:
                lines.append((self._free(f"{before}{n}"), x))
                x = sympy.Symbol(lines[-1][0], real=True)
            results.append(x)
        return tuple(lines), results

    def jacobian(self) -> Lines:
        """Return the lines of the product of the parts' Jacobians."""
        lines: list[tuple[str, sympy.Expr]] = []
        size = len(self.state)
        total = sympy.eye(size)
        last = len(self.parts) - 1
        for k, (part, pair) in enumerate(zip(self.parts, self.formulas, strict=True)):
            entries = part.jacobian
            state_lines, part_entries = (
                self._common("x", entries) if k == last else self._move_state(k, pair, entries)
            )
            value_lines, names = self._name_values(
                f"j{k}_", sympy.Matrix(size, size, part_entries) * total
            )
            lines += state_lines
            if k < last:
                lines += value_lines
                total = sympy.Matrix(size, size, names)
            else:
                total = sympy.Matrix(size, size, part_entries) * total
        return (*lines, *zip(self.outputs["jacobian"], total, strict=True))

    def delta_j(self) -> Lines:
        """Return the lines of ΔJ: 0 if proved, else its closed form, else from the parts."""
        if self.map.has_closed_form:
            lines, (total,) = self._common("x", [self.map.delta_j.xreplace(self.renaming)])
            return (*lines, ("delta_j", total))
        statements: list[tuple[str, sympy.Expr]] = []
        total = sympy.S.Zero
        for k, (part, pair) in enumerate(zip(self.parts, self.formulas, strict=True)):
            state_lines, (change,) = self._move_state(k, pair, [part.delta_j])
            statements += state_lines
            name = self._free(f"d{k}")
            # (1 + x)(1 + y) − 1 = x + y + xy, without subtracting 1.
            statements.append((name, total + change + total * change))
            total = sympy.Symbol(name, real=True)
        return (*statements, ("delta_j", total))
