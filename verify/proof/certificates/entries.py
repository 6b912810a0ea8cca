"""The entries of a certificate, each checked for its type and range: nothing in it is trusted.

Every reader raises ValueError with the name of the entry. Entries that no reader takes are refused,
and so are undefined names. A term may contain the coordinates, t if H depends on time, and for one
H the parameters and the functions listed before the term, for every H the derivatives of H. t is
never a parameter, or a printed formula would be read as that of another H.

Coordinates are p and q, or p1 … pn, q1 … qn in a certificate with `degrees`. A 2-form is given by
its entries above the diagonal, by the names of two coordinates; in the plane it has one.
"""

import re
from dataclasses import dataclass
from fractions import Fraction

from verify.proof.certificates.coefficients import ButcherTableau, Stages, read_coefficients
from verify.proof.certificates.readers import (
    MOST_FACTORS,
    MOST_ORDERS,
    PLANE,
    RESERVED,
    CoordinateLayout,
    Poly,
    UnreadEntries,
    array_of,
    need,
    number_of,
    object_of,
    poly_of,
    short,
    text_of,
)

Form = dict[tuple[str, str], Poly]  # entries that are not 0

# A parameter must not look like a derivative of H or a coordinate.
_PARAMETER_NAME = re.compile(r"(?!H_|[pq][0-9]+$)[A-Za-z][A-Za-z0-9_]{0,63}")
KINDS = ("sin", "cos", "exp", "inverse")
_DERIVATIVE_NAME = re.compile("H_((?:[pq][0-9]{0,2}|t)+)")
_VARIABLE_NAME = re.compile("[pq][0-9]*|t")


@dataclass(frozen=True)
class NamedFunction:
    """A name for sin, cos or exp of an argument, or for 1/argument."""

    name: str
    kind: str
    argument: Poly


@dataclass(frozen=True)
class Expansion:
    """A map as coefficients of powers of h, and the statements about it.

    `after`: for each of `coordinates`, the coefficients of its new value. `hamiltonian`: None for
    every H. `timed`: True if H depends on t.
    """

    layout: CoordinateLayout
    hamiltonian: Poly | None
    separable: bool
    timed: bool
    parameters: tuple[str, ...]
    functions: tuple[NamedFunction, ...]
    after: tuple[tuple[Poly, ...], ...]
    convergence_order: int
    order: int | None
    leading: Form
    potential: Form | None
    witness: dict[str, Fraction]
    cofactors: dict[str, dict[str, Poly]]

    @property
    def last(self) -> int | None:
        """The last power of h that a statement is about; None if the map is a polynomial in h."""
        return None if self.order is None else max(self.order, self.convergence_order)

    @property
    def length(self) -> int:
        """The largest number of coefficients of a coordinate's new value."""
        return max(map(len, self.after))

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The names of the coordinates: p and q, or p1 … pn, q1 … qn."""
        return self.layout.coordinates


def read(data: object) -> Stages | ButcherTableau | Expansion:
    """Read the entries of a certificate; ValueError for an entry without a meaning."""
    entries = _Entries(data)
    kind = next((kind for kind in ("stages", "tableau") if kind in entries.unread), None)
    result = entries.expansion() if kind is None else read_coefficients(entries, kind)
    need(not entries.unread, f"no entry of this name: {short(min(entries.unread, default=''))}")
    return result


class _Entries(UnreadEntries):
    """The reader of the entries about a map."""

    def __init__(self, data: object) -> None:
        super().__init__(data)
        self.names: set[str] = set()
        self.every = self.separable = False
        self.coordinates = self.layout.coordinates

    def expansion(self) -> Expansion:
        hamiltonian = self.take("hamiltonian")
        self.every = hamiltonian == "every"
        self.separable = self.flag("separable") if self.every else False
        parameters = () if self.every else self.parameters()
        self.names = {*self.coordinates, *(["t"] if self.timed else []), *parameters}
        functions = () if self.every else self.functions()
        return Expansion(
            layout=self.layout,
            hamiltonian=None if self.every else self.poly(hamiltonian, "hamiltonian"),
            separable=self.separable,
            timed=self.timed,
            parameters=parameters,
            functions=functions,
            after=self.after(),
            convergence_order=self.whole("convergence_order", 0),
            order=self.order(),
            leading=self.form("leading"),
            potential=self.form("potential") if "potential" in self.unread else None,
            witness={} if self.every else self.witness(),
            cofactors={} if self.every else self.cofactors(),
        )

    def order(self) -> int | None:
        if "order" in self.unread and self.unread["order"] is None:
            self.unread.pop("order")
            return None
        return self.whole("order", 1)

    def form(self, name: str) -> Form:
        listed, entries = self.take(name), Form()
        for item in [[*PLANE, listed]] if self.layout.single else array_of(listed, name):
            entry = array_of(item, name)
            need(len(entry) == 3, f"{name}: each entry is two coordinates and a polynomial")
            a, b = text_of(entry[0], name), text_of(entry[1], name)
            places = [self.coordinates.index(x) for x in (a, b) if x in self.coordinates]
            problem = f"{name}: {short(a)}, {short(b)} are no two coordinates in their order"
            need(len(places) == 2 and places[0] < places[1], problem)
            # A 2-form is antisymmetric, so that the entries above the diagonal determine it.
            need((a, b) not in entries, f"{name}: {short(a)}, {short(b)} stand twice")
            entries[a, b] = self.poly(entry[2], name)
        return {pair: x for pair, x in entries.items() if x}

    def after(self) -> tuple[tuple[Poly, ...], ...]:
        if self.layout.single:
            return tuple(self.series(self.take(name), name) for name in ("p_next", "q_next"))
        by_name = object_of(self.take("next"), "next")
        problem = f"next: has a list for each of {', '.join(self.coordinates)}"
        need(set(by_name) == set(self.coordinates), problem)
        return tuple(self.series(by_name[name], f"next of {name}") for name in self.coordinates)

    def parameters(self) -> tuple[str, ...]:
        names = [text_of(x, "parameters") for x in array_of(self.take("parameters"), "parameters")]
        for name in names:
            fits = _PARAMETER_NAME.fullmatch(name) and name not in {*RESERVED, *self.coordinates}
            need(fits and names.count(name) == 1, f"parameters: {short(name)} is no new name")
        return tuple(names)

    def functions(self) -> tuple[NamedFunction, ...]:
        listed = []
        for item in array_of(self.take("functions"), "functions"):
            entry = array_of(item, "functions")
            need(len(entry) == 3, "functions: each is a name, a kind and an argument")
            name, kind = text_of(entry[0], "functions"), text_of(entry[1], "functions")
            new = re.fullmatch("#[0-9]{1,6}", name) and name not in self.names
            need(new, f"functions: {short(name)} is no new name such as #1")
            need(kind in KINDS, f"functions: {short(kind)} is none of {', '.join(KINDS)}")
            listed.append(NamedFunction(name, kind, self.poly(entry[2], name)))
            # Only later functions may use this name, so that arguments have no cycles.
            self.names.add(name)
        return tuple(listed)

    def series(self, data: object, name: str) -> tuple[Poly, ...]:
        listed = array_of(data, name)
        need(len(listed) <= MOST_ORDERS + 1, f"{name}: has more than {MOST_ORDERS + 1} entries")
        return tuple(self.poly(coefficient, name) for coefficient in listed)

    def witness(self) -> dict[str, Fraction]:
        point = object_of(self.take("witness"), "witness")
        variables = {name for name in self.names if not name.startswith("#")}
        pair = ", ".join(PLANE) if self.layout.single else "the coordinates"
        hint = f"witness: gives values to {pair} and the parameters: {', '.join(sorted(variables))}"
        need(not point or set(point) == variables, hint)
        return {name: number_of(x, "witness") for name, x in point.items()}

    def cofactors(self) -> dict[str, dict[str, Poly]]:
        by_identity = object_of(self.take("cofactors"), "cofactors")
        return {
            key: {name: self.poly(x, f"cofactors of {short(key)}") for name, x in sums.items()}
            for key, sums in ((key, object_of(x, "cofactors")) for key, x in by_identity.items())
        }

    def poly(self, data: object, what: str) -> Poly:
        return poly_of(data, what, self._is_name)

    def _is_name(self, name: str) -> bool:
        if name in self.names:
            return True
        if not self.every or len(name) > MOST_FACTORS or not _DERIVATIVE_NAME.fullmatch(name):
            return False
        names = derived_by(name)
        order = [*self.coordinates, *(["t"] if self.timed else [])]
        if not all(x in order for x in names):
            return False
        # For H = T(p) + V(q) the mixed derivatives are 0 and have no name.
        mixed = len({x[0] for x in names} & set(PLANE)) == 2
        return names == sorted(names, key=order.index) and not (self.separable and mixed)


def derived_by(name: str) -> list[str]:
    """Return the variables by which H is differentiated in H_…, with repetitions."""
    return _VARIABLE_NAME.findall(name.removeprefix("H_"))
