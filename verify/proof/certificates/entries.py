"""A certificate's entries, each of a type and within a range: nothing in the file is believed.

Every reader raises ValueError, which names the entry. What none of them asks for is refused, and so
is a name that stands for nothing: a term's names are the coordinates, t where H depends on time,
the parameters and the functions that stand before it, or, for every H, the derivatives of H. t is
time and no parameter, with which the formulas that are printed would be read as those of another H.

Coordinates are p and q, or p1 … pn, q1 … qn of a certificate with `degrees`. A 2-form is its
entries above the diagonal, by the names of the two coordinates; in the plane it has one.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

Monomial = tuple[str, ...]  # names in order, a name once for each power
Poly = dict[Monomial, Fraction]
Form = dict[tuple[str, str], Poly]  # entries that are not 0

PLANE = ("p", "q")
MOST_ORDERS = 128
MOST_DEGREES = 16
MOST_FACTORS = 256  # in a term
_NUMBER = re.compile(r"(-?[0-9]{1,2000})(?:/([1-9][0-9]{0,1999}))?")
_PARAMETER = re.compile(r"(?!H_)[A-Za-z][A-Za-z0-9_]{0,63}")
_RESERVED = {"p", "q", "h", "t", "sin", "cos", "exp", "log", "sqrt", "pi", "e", "i", "E", "I"}
_KINDS = ("sin", "cos", "exp", "inverse")
_DERIVATIVE = re.compile("H_((?:[pq][0-9]{0,2}|t)+)")
_ONE = re.compile("[pq][0-9]*|t")


@dataclass(frozen=True)
class Function:
    """A name for sin, cos or exp of an argument, or for 1/argument."""

    name: str
    kind: str
    argument: Poly


@dataclass(frozen=True)
class Stages:
    """Rows (kick, drift, share of p', share of q') of a scheme for every H.

    `times`: one of each row, in parts of h from the step's start; None where H has no time.
    `degrees` of freedom: None in the plane.
    """

    separable: bool
    rows: tuple[tuple[Fraction, Fraction, Fraction, Fraction], ...]
    times: tuple[Fraction, ...] | None
    degrees: int | None = None


@dataclass(frozen=True)
class Expansion:
    """A map as coefficients of powers of h, and what is said of it.

    `after`: those of each coordinate's new value, in the order of `coordinates`. `hamiltonian`
    None: every H; `timed`: H depends on t.
    """

    coordinates: tuple[str, ...]
    hamiltonian: Poly | None
    separable: bool
    timed: bool
    parameters: tuple[str, ...]
    functions: tuple[Function, ...]
    after: tuple[tuple[Poly, ...], ...]
    convergence_order: int
    order: int | None
    leading: Form
    potential: Form | None
    witness: dict[str, Fraction]
    cofactors: dict[str, dict[str, Poly]]

    @property
    def last(self) -> int | None:
        """The last power of h of which anything is said; None: the map is a polynomial in h."""
        return None if self.order is None else max(self.order, self.convergence_order)

    @property
    def planar(self) -> bool:
        """Whether it is of p and q."""
        return self.coordinates == PLANE


def need(holds: object, what: str) -> None:
    """ValueError with these words, unless it holds."""
    if not holds:
        raise ValueError(what)


def read(data: object) -> Stages | Expansion:
    """The entries of a certificate. Raises ValueError for what has no meaning."""
    entries = _Entries(data)
    found = entries.stages() if "stages" in entries.left else entries.expansion()
    need(not entries.left, f"no entry of this name: {_short(min(entries.left, default=''))}")
    return found


class _Entries:
    """The entries that have not been read yet."""

    def __init__(self, data: object) -> None:
        self.left = dict(_object(data, "the certificate"))
        self.left.pop("format", None)  # which who opens the file looks at
        self.names: set[str] = set()
        self.every = self.separable = False
        self.timed = "time_dependent" in self.left and self.flag("time_dependent")
        self.degrees = self.whole("degrees", 1, MOST_DEGREES) if "degrees" in self.left else None
        numbers = range(1, (self.degrees or 0) + 1)
        several = tuple(f"{letter}{k}" for letter in PLANE for k in numbers)
        self.coordinates = several or PLANE

    def take(self, name: str) -> object:
        need(name in self.left, f"{name} is missing")
        return self.left.pop(name)

    def stages(self) -> Stages:
        need(self.take("hamiltonian") == "every", "stages are those of every hamiltonian")
        separable, rows = self.flag("separable"), _array(self.take("stages"), "stages")
        need(0 < len(rows) <= 1000, "stages: has 1 to 1000 rows")
        found, times, length = [], [], 4 + self.timed
        for row in rows:
            numbers = _array(row, "stages")
            need(len(numbers) == length, f"stages: a row has {length} numbers")
            kick, drift, at_p, at_q, *time = (_number(x, "stages") for x in numbers)
            found.append((kick, drift, at_p, at_q))
            times += time
        return Stages(separable, tuple(found), tuple(times) if self.timed else None, self.degrees)

    def expansion(self) -> Expansion:
        hamiltonian = self.take("hamiltonian")
        self.every = hamiltonian == "every"
        self.separable = self.flag("separable") if self.every else False
        parameters = () if self.every else self.parameters()
        self.names = {*self.coordinates, *(["t"] if self.timed else []), *parameters}
        functions = () if self.every else self.functions()
        return Expansion(
            coordinates=self.coordinates,
            hamiltonian=None if self.every else self.poly(hamiltonian, "hamiltonian"),
            separable=self.separable,
            timed=self.timed,
            parameters=parameters,
            functions=functions,
            after=self.after(),
            convergence_order=self.whole("convergence_order", 0),
            order=self.order(),
            leading=self.form("leading"),
            potential=self.potential(),
            witness={} if self.every else self.witness(),
            cofactors={} if self.every else self.cofactors(),
        )

    def order(self) -> int | None:
        if "order" in self.left and self.left["order"] is None:
            self.left.pop("order")
            return None
        return self.whole("order", 1)

    def potential(self) -> Form | None:
        return self.form("potential") if "potential" in self.left else None

    def form(self, name: str) -> Form:
        if self.degrees is None:
            only = self.poly(self.take(name), name)
            return {PLANE: only} if only else {}
        found: Form = {}
        for each in _array(self.take(name), name):
            three = _array(each, name)
            need(len(three) == 3, f"{name}: each entry is two coordinates and a polynomial")
            a, b = _text(three[0], name), _text(three[1], name)
            places = [self.coordinates.index(x) for x in (a, b) if x in self.coordinates]
            said = f"{name}: {_short(a)}, {_short(b)} are no two coordinates in their order"
            need(len(places) == 2 and places[0] < places[1], said)
            need((a, b) not in found, f"{name}: {_short(a)}, {_short(b)} stand twice")
            found[a, b] = self.poly(three[2], name)
        return {place: x for place, x in found.items() if x}

    def after(self) -> tuple[tuple[Poly, ...], ...]:
        if self.degrees is None:
            return self.series(self.take("p_next"), "p_next"), self.series(
                self.take("q_next"), "q_next"
            )
        given = _object(self.take("next"), "next")
        said = f"next: has a list for each of {', '.join(self.coordinates)}"
        need(set(given) == set(self.coordinates), said)
        return tuple(self.series(given[name], f"next of {name}") for name in self.coordinates)

    def flag(self, name: str) -> bool:
        value = self.take(name)
        need(isinstance(value, bool), f"{name}: {_short(value)} is not true or false")
        return value is True

    def whole(self, name: str, least: int, most: int = MOST_ORDERS) -> int:
        value = self.take(name)
        whole = isinstance(value, int) and not isinstance(value, bool)
        said = f"{name}: {_short(value)} is no whole number from {least} to {most}"
        need(whole and least <= value <= most, said)  # type: ignore[operator]
        return value  # type: ignore[return-value]

    def parameters(self) -> tuple[str, ...]:
        found = [_text(x, "parameters") for x in _array(self.take("parameters"), "parameters")]
        for name in found:
            fits = _PARAMETER.fullmatch(name) and name not in {*_RESERVED, *self.coordinates}
            need(fits and found.count(name) == 1, f"parameters: {_short(name)} is no new name")
        return tuple(found)

    def functions(self) -> tuple[Function, ...]:
        found = []
        for each in _array(self.take("functions"), "functions"):
            three = _array(each, "functions")
            need(len(three) == 3, "functions: each is a name, a kind and an argument")
            name, kind = _text(three[0], "functions"), _text(three[1], "functions")
            new = re.fullmatch("#[0-9]{1,6}", name) and name not in self.names
            need(new, f"functions: {_short(name)} is no new name such as #1")
            need(kind in _KINDS, f"functions: {_short(kind)} is none of {', '.join(_KINDS)}")
            found.append(Function(name, kind, self.poly(three[2], name)))
            self.names.add(name)
        return tuple(found)

    def series(self, data: object, name: str) -> tuple[Poly, ...]:
        given = _array(data, name)
        need(len(given) <= MOST_ORDERS + 1, f"{name}: has more than {MOST_ORDERS + 1} entries")
        return tuple(self.poly(each, name) for each in given)

    def witness(self) -> dict[str, Fraction]:
        given = _object(self.take("witness"), "witness")
        variables = {name for name in self.names if not name.startswith("#")}
        both = ", ".join(PLANE) if self.degrees is None else "the coordinates"
        said = f"witness: gives values to {both} and the parameters: {', '.join(sorted(variables))}"
        need(not given or set(given) == variables, said)
        return {name: _number(x, "witness") for name, x in given.items()}

    def cofactors(self) -> dict[str, dict[str, Poly]]:
        given = _object(self.take("cofactors"), "cofactors")
        return {
            what: {name: self.poly(x, f"cofactors of {_short(what)}") for name, x in each.items()}
            for what, each in ((key, _object(x, "cofactors")) for key, x in given.items())
        }

    def poly(self, data: object, what: str) -> Poly:
        terms = []
        for term in _array(data, what):
            number, *names = _array(term, what) or [None]
            need(len(names) <= MOST_FACTORS, f"{what}: has more than {MOST_FACTORS} factors")
            for name in names:
                need(self._known(_text(name, what)), f"{what}: {_short(name)} stands for nothing")
            terms.append((tuple(map(str, names)), _number(number, what)))
        return collected(terms)

    def _known(self, name: str) -> bool:
        if name in self.names:
            return True
        if not self.every or len(name) > MOST_FACTORS or not _DERIVATIVE.fullmatch(name):
            return False
        by = derived_by(name)
        order = [*self.coordinates, *(["t"] if self.timed else [])]
        if not all(x in order for x in by):
            return False
        mixed = len({x[0] for x in by} & set(PLANE)) == 2
        return by == sorted(by, key=order.index) and not (self.separable and mixed)


def derived_by(name: str) -> list[str]:
    """By which names H is derived in the name of a derivative, one for each time."""
    return _ONE.findall(name.removeprefix("H_"))


def collected(terms: Iterable[tuple[Monomial, Fraction]]) -> Poly:
    """The sum of the terms."""
    total: Poly = {}
    for names, c in terms:
        key = tuple(sorted(names))
        total[key] = total[key] + c if key in total else c
    return {names: c for names, c in total.items() if c}


def _object(data: object, what: str) -> dict[str, object]:
    need(isinstance(data, dict), f"{what}: {_short(data)} is no object")
    return data  # type: ignore[return-value]


def _array(data: object, what: str) -> list[object]:
    need(isinstance(data, list), f"{what}: {_short(data)} is no list")
    return data  # type: ignore[return-value]


def _text(data: object, what: str) -> str:
    need(isinstance(data, str), f"{what}: {_short(data)} is no text")
    return data  # type: ignore[return-value]


def _number(data: object, what: str) -> Fraction:
    found = _NUMBER.fullmatch(data) if isinstance(data, str) else None
    need(found, f"{what}: {_short(data)} is no rational number such as '-3/2'")
    above, below = found.groups()  # type: ignore[union-attr]
    return Fraction(int(above), int(below or 1))


def _short(data: object) -> str:
    shown = ascii(data) if not isinstance(data, list | dict) else type(data).__name__
    return shown if len(shown) <= 40 else f"{shown[:40]}…"
