"""The structures that a user names: `energy`, `volume: 3`, `q1*p2 - q2*p1`, and what refines them.

A request is a name or the formula of a first integral; `: k` behind it claims that the defect of
one step is O(h^k), in place of 0.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from verify.algebra.formula import parse, symbol
from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.lazy_sympy import sympy
from verify.structures import AREA, SYMPLECTIC
from verify.structures.conformal import Conformal
from verify.structures.first_integral import FirstIntegral
from verify.structures.poisson import Poisson
from verify.structures.reversible import Reversible
from verify.structures.structure import Structure, is_zero
from verify.structures.symmetric import SYMMETRIC
from verify.structures.symplectic import Entries, SymplecticForm, canonical_entries
from verify.structures.volume import Volume

NAMES = (
    "area", "symplectic", "volume", "energy", "momentum", "angular-momentum", "reversible",
    "symmetric", "conformal", "poisson",
)  # fmt: skip
_CLAIM = re.compile(r"(.*\S)\s*:\s*(\S*)", re.DOTALL)
_PAIR = re.compile(r"\bd(\w+)\s*(?:\^|∧|/\\)\s*d(\w+)\b")
_MOST_CLAIMED = 20
_ANGULAR = {2: ((1, 2),), 3: ((2, 3), (3, 1), (1, 2))}


class System(Protocol):
    """The system whose step is judged."""

    @property
    def coordinates(self) -> tuple[str, ...]: ...
    @property
    def parameters(self) -> tuple[str, ...]: ...
    @property
    def time_dependent(self) -> bool: ...
    @property
    def energy(self) -> sympy.Expr | None: ...


@dataclass(frozen=True)
class KeepsRequest:
    """The structures asked for, as texts.

    `keeps`: names or formulas, each perhaps with an order. The others refine a structure and imply
    it if it is not named: `form` the 2-form of `symplectic`, `density` that of `volume`, `poisson`
    the rows of a matrix with its `casimirs`, `reverses` the reflection of `reversible`, `factor`
    that of `conformal`.
    """

    keeps: tuple[str, ...] = ()
    form: str = ""
    density: str = ""
    poisson: str = ""
    casimirs: tuple[str, ...] = ()
    reverses: str = ""
    factor: str = ""

    def __bool__(self) -> bool:
        return any(vars(self).values())


@dataclass(frozen=True)
class ClaimedStructure:
    """A structure with the claimed order of its defect; None if the defect is claimed to vanish."""

    structure: Structure
    order: int | None = None


@dataclass
class _Reader:
    request: KeepsRequest
    system: System
    result: list[ClaimedStructure] = field(default_factory=list)

    def read(self) -> list[ClaimedStructure]:
        for text in self._texts():
            name, order = _split(text)
            for structure in self._structures(name):
                self.result.append(ClaimedStructure(structure, order))
        return self.result

    def _texts(self) -> list[str]:
        """Return the requests, and those that an option implies."""
        request, texts = self.request, list(self.request.keeps)
        named = {_split(text)[0].lower() for text in texts}
        implied = {
            "symplectic": request.form and not request.factor, "volume": request.density,
            "poisson": request.poisson or request.casimirs, "reversible": request.reverses,
            "conformal": request.factor,
        }  # fmt: skip
        return texts + [name for name, text in implied.items() if text and name not in named]

    def _structures(self, name: str) -> Iterator[Structure]:
        key = name.lower().replace("_", "-")
        if key in NAMES:
            yield from getattr(self, f"_{key.replace('-', '_')}")()
        elif re.fullmatch(r"[A-Za-z-]+", name) and not {*name.split("-")} <= {*self._names, ""}:
            raise unknown_name("--keeps", name, NAMES, ", or a formula of a first integral")
        else:
            yield FirstIntegral(name, name, self._formula(name, "--keeps"))

    @property
    def _names(self) -> tuple[str, ...]:
        time = ("t",) if self.system.time_dependent else ()
        return (*self.system.coordinates, *time, *self.system.parameters)

    def _formula(self, text: str, source: str, *more_names: str) -> sympy.Expr:
        return parse(text, (*self._names, *more_names), source=source)

    # -- by names ---------------------------------------------------------------------------------

    def _area(self) -> Iterator[Structure]:
        if len(self.system.coordinates) != 2:
            problem = "is of one degree of freedom; allowed here: symplectic, volume"
            raise InputError("--keeps", "area", problem)
        is_field = self.system.energy is None
        yield Volume("area", "area", sympy.S.One) if is_field else AREA

    def _symplectic(self) -> Iterator[Structure]:
        if self.request.form:
            yield SymplecticForm("symplectic", self.request.form, self._entries())
            return
        self._check_canonical("symplectic", '--form, such as "dv^dx"')
        yield AREA if len(self.system.coordinates) == 2 else SYMPLECTIC

    def _volume(self) -> Iterator[Structure]:
        density, label = sympy.S.One, "volume"
        if self.request.density:
            density = self._formula(self.request.density, "--density")
            label = f"volume with the density {self.request.density}"
        yield Volume("volume", label, density)

    def _energy(self) -> Iterator[Structure]:
        if self.system.energy is None:
            problem = "a system without H has none; write the formula of a first integral"
            raise InputError("--keeps", "energy", problem)
        if self.system.time_dependent:
            raise InputError("--keeps", "energy", "H depends on t, and is no first integral")
        yield FirstIntegral("energy", "energy", self.system.energy)

    def _momentum(self) -> Iterator[Structure]:
        self._check_canonical("momentum", "the formula of a first integral")
        momenta = self.system.coordinates[: len(self.system.coordinates) // 2]
        total = sympy.Add(*map(symbol, momenta))
        yield FirstIntegral("momentum", f"momentum {' + '.join(momenta)}", total)

    def _angular_momentum(self) -> Iterator[Structure]:
        self._check_canonical("angular-momentum", "the formula of a first integral")
        degrees = len(self.system.coordinates) // 2
        if degrees not in _ANGULAR:
            problem = f"is of two or three degrees of freedom, and there are {degrees};"
            raise InputError("--keeps", "angular-momentum", f"{problem} write its formula")
        for i, j in _ANGULAR[degrees]:
            text = f"q{i}*p{j} - q{j}*p{i}"
            label = f"angular momentum {text}"
            yield FirstIntegral("angular-momentum", label, self._formula(text, "--keeps"))

    def _reversible(self) -> Iterator[Structure]:
        if self.system.time_dependent:
            raise InputError("--keeps", "reversible", "is of systems that do not depend on t")
        names = self.system.coordinates
        if self.request.reverses:
            formulas = tuple(
                self._formula(x, "--reverses") for x in self.request.reverses.split(",")
            )
            label = f"reversible by ({self.request.reverses.strip()})"
            yield Reversible("reversible", label, formulas)
            return
        self._check_canonical("reversible", '--reverses, such as "-v, x"')
        half = len(names) // 2
        signed = (symbol(name) * (-1 if k < half else 1) for k, name in enumerate(names))
        yield Reversible("reversible", "reversible by p ↦ −p", tuple(signed))

    def _symmetric(self) -> Iterator[Structure]:
        yield SYMMETRIC

    def _conformal(self) -> Iterator[Structure]:
        if not self.request.factor:
            problem = "is missing: the factor of the form in one step, such as exp(-gamma*h)"
            raise InputError("--factor", NOT_GIVEN, problem)
        factor = self._formula(self.request.factor, "--factor", "h")
        strange = {x.name for x in factor.free_symbols} & {*self.system.coordinates, "t"}
        if strange:
            problem = f"has {min(strange)}; allowed: h and parameters"
            raise InputError("--factor", self.request.factor, problem)
        if not self.request.form:
            self._check_canonical("conformal", '--form, such as "dv^dx"')
        entries = (
            self._entries()
            if self.request.form
            else canonical_entries(len(self.system.coordinates))
        )
        label = f"conformal with the factor {self.request.factor}"
        yield Conformal("conformal", label, factor, entries)

    def _poisson(self) -> Iterator[Structure]:
        if not self.request.poisson:
            problem = "is missing: the matrix of the bracket, rows by ;, entries by ,"
            raise InputError("--poisson", NOT_GIVEN, problem)
        names = self.system.coordinates
        rows = [
            [self._formula(x, "--poisson") for x in row.split(",")]
            for row in self.request.poisson.split(";")
        ]
        size = len(names)
        if [len(row) for row in rows] != [size] * size:
            problem = f"is no matrix of {size} rows by ; with {size} entries by , each"
            raise InputError("--poisson", self.request.poisson, problem)
        for a in range(size):
            for b in range(a + 1):
                if is_zero(rows[a][b] + rows[b][a], self._names) is not True:
                    problem = f"is not antisymmetric: {{{names[b]}, {names[a]}}}"
                    raise InputError("--poisson", self.request.poisson, problem)
        entries: Entries = {
            (a, b): rows[a][b] for a in range(size) for b in range(a + 1, size) if rows[a][b] != 0
        }
        bracket = Poisson("poisson", "the Poisson structure", entries)
        yield bracket
        for text in self.request.casimirs:
            casimir = self._formula(text, "--casimir")
            slopes = sympy.Matrix([casimir.diff(symbol(name)) for name in names])
            if any(is_zero(x, self._names) is not True for x in bracket.matrix(size) * slopes):
                raise InputError("--casimir", text, "is no Casimir: B times its gradient is not 0")
            yield FirstIntegral("casimir", f"Casimir {text}", casimir)

    def _check_canonical(self, name: str, instead: str) -> None:
        """Raise InputError if the system has no p and q of its own."""
        # A map has no H, and may have p and q.
        if not getattr(self.system, "canonical", self.system.energy is not None):
            problem = f"a system without H has no p and q; write {instead}"
            raise InputError("--keeps", name, problem)

    def _entries(self) -> Entries:
        """Return the coefficients of the 2-form in `form`."""
        text, names = self.request.form, self.system.coordinates
        places: dict[str, tuple[int, int, int]] = {}
        prefix = "d" + "_" * (1 + max(map(len, self._names)))  # longer than any name

        def placeholder(match: re.Match[str]) -> str:
            for name in match.groups():
                if name not in names:
                    raise unknown_name("--form", name, names)
            a, b = map(names.index, match.groups())
            if a == b:
                raise InputError("--form", text, f"has d{names[a]}^d{names[a]}, which is 0")
            mark = f"{prefix}{len(places)}"
            places[mark] = (min(a, b), max(a, b), 1 if a < b else -1)
            return f"({mark})"

        marked = _PAIR.sub(placeholder, text)
        try:
            expression = self._formula(marked, "--form", *places)
        except InputError as error:  # without the marks, which the user did not write
            problem = re.sub(rf"^.*column \d+: |\b{prefix}\d+, ", "", error.problem)
            raise type(error)("--form", text, problem) from None
        entries: dict[tuple[int, int], sympy.Expr] = {}
        marks = {symbol(mark): place for mark, place in places.items()}
        rest = expression - sum((mark * expression.diff(mark) for mark in marks), sympy.S.Zero)
        slopes = [expression.diff(mark) for mark in marks]
        nonlinear = any(x.free_symbols & marks.keys() for x in slopes)
        if nonlinear or is_zero(rest, (*self._names, *places)) is not True:
            raise InputError("--form", text, "is no sum of coefficients times dx^dy")
        for (a, b, sign), x in zip(marks.values(), slopes, strict=True):
            entries[a, b] = entries.get((a, b), sympy.S.Zero) + sign * x
        return entries


def _split(text: str) -> tuple[str, int | None]:
    """Return the name or formula of a request, and the order behind its colon."""
    match = _CLAIM.fullmatch(text.strip())
    if match is None:
        if not text.strip():
            raise InputError("--keeps", text, "is empty; give a name or a formula")
        return text.strip(), None
    name, order = match.groups()
    if not order.isdecimal() or not 1 <= int(order) <= _MOST_CLAIMED:
        problem = f"the order behind the colon is a whole number, 1 … {_MOST_CLAIMED}"
        raise InputError("--keeps", text, problem)
    return name, int(order)


def read_structures(request: KeepsRequest, system: System) -> Sequence[ClaimedStructure]:
    """Return the structures of a request. Raises InputError, one line, for a bad one."""
    return _Reader(request, system).read()
