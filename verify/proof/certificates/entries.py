"""A certificate's entries, each of a type and within a range: nothing in the file is believed.

Every reader raises ValueError, which names the entry. What none of them asks for is refused, and so
is a name that stands for nothing: a term's names are the coordinates, t where H depends on time,
the parameters and the functions that stand before it, or, for every H, the derivatives of H. t is
time and no parameter, with which the formulas that are printed would be read as those of another H.

Coordinates are p and q, or p1 … pn, q1 … qn of a certificate with `degrees`. A 2-form is its
entries above the diagonal, by the names of the two coordinates; in the plane it has one.
"""

import re
from dataclasses import dataclass
from fractions import Fraction

from verify.proof.certificates.coefficients import Stages, Tableau, read_coefficients
from verify.proof.certificates.readers import (
    MOST_FACTORS,
    MOST_ORDERS,
    PLANE,
    RESERVED,
    Layout,
    Left,
    Poly,
    array_of,
    need,
    number_of,
    object_of,
    poly_of,
    short,
    text_of,
)

Form = dict[tuple[str, str], Poly]  # entries that are not 0

_PARAMETER = re.compile(r"(?!H_|[pq][0-9]+$)[A-Za-z][A-Za-z0-9_]{0,63}")
KINDS = ("sin", "cos", "exp", "inverse")
_DERIVATIVE = re.compile("H_((?:[pq][0-9]{0,2}|t)+)")
_ONE = re.compile("[pq][0-9]*|t")


@dataclass(frozen=True)
class Function:
    """A name for sin, cos or exp of an argument, or for 1/argument."""

    name: str
    kind: str
    argument: Poly


@dataclass(frozen=True)
class Expansion:
    """A map as coefficients of powers of h, and what is said of it.

    `after`: those of each coordinate's new value, in the order of `coordinates`. `hamiltonian`
    None: every H; `timed`: H depends on t.
    """

    layout: Layout
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
    def length(self) -> int:
        """How many coefficients of the map there are."""
        return max(map(len, self.after))

    @property
    def coordinates(self) -> tuple[str, ...]:
        """p and q, or p1 … pn, q1 … qn."""
        return self.layout.coordinates


def read(data: object) -> Stages | Tableau | Expansion:
    """The entries of a certificate. Raises ValueError for what has no meaning."""
    entries = _Entries(data)
    kind = next((kind for kind in ("stages", "tableau") if kind in entries.left), None)
    found = entries.expansion() if kind is None else read_coefficients(entries, kind)
    need(not entries.left, f"no entry of this name: {short(min(entries.left, default=''))}")
    return found


class _Entries(Left):
    """Those of a map and what is said of it."""

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
            potential=self.form("potential") if "potential" in self.left else None,
            witness={} if self.every else self.witness(),
            cofactors={} if self.every else self.cofactors(),
        )

    def order(self) -> int | None:
        if "order" in self.left and self.left["order"] is None:
            self.left.pop("order")
            return None
        return self.whole("order", 1)

    def form(self, name: str) -> Form:
        given, found = self.take(name), Form()
        for each in [[*PLANE, given]] if self.layout.single else array_of(given, name):
            three = array_of(each, name)
            need(len(three) == 3, f"{name}: each entry is two coordinates and a polynomial")
            a, b = text_of(three[0], name), text_of(three[1], name)
            places = [self.coordinates.index(x) for x in (a, b) if x in self.coordinates]
            said = f"{name}: {short(a)}, {short(b)} are no two coordinates in their order"
            need(len(places) == 2 and places[0] < places[1], said)
            need((a, b) not in found, f"{name}: {short(a)}, {short(b)} stand twice")
            found[a, b] = self.poly(three[2], name)
        return {place: x for place, x in found.items() if x}

    def after(self) -> tuple[tuple[Poly, ...], ...]:
        if self.layout.single:
            return tuple(self.series(self.take(name), name) for name in ("p_next", "q_next"))
        given = object_of(self.take("next"), "next")
        said = f"next: has a list for each of {', '.join(self.coordinates)}"
        need(set(given) == set(self.coordinates), said)
        return tuple(self.series(given[name], f"next of {name}") for name in self.coordinates)

    def parameters(self) -> tuple[str, ...]:
        found = [text_of(x, "parameters") for x in array_of(self.take("parameters"), "parameters")]
        for name in found:
            fits = _PARAMETER.fullmatch(name) and name not in {*RESERVED, *self.coordinates}
            need(fits and found.count(name) == 1, f"parameters: {short(name)} is no new name")
        return tuple(found)

    def functions(self) -> tuple[Function, ...]:
        found = []
        for each in array_of(self.take("functions"), "functions"):
            three = array_of(each, "functions")
            need(len(three) == 3, "functions: each is a name, a kind and an argument")
            name, kind = text_of(three[0], "functions"), text_of(three[1], "functions")
            new = re.fullmatch("#[0-9]{1,6}", name) and name not in self.names
            need(new, f"functions: {short(name)} is no new name such as #1")
            need(kind in KINDS, f"functions: {short(kind)} is none of {', '.join(KINDS)}")
            found.append(Function(name, kind, self.poly(three[2], name)))
            self.names.add(name)
        return tuple(found)

    def series(self, data: object, name: str) -> tuple[Poly, ...]:
        given = array_of(data, name)
        need(len(given) <= MOST_ORDERS + 1, f"{name}: has more than {MOST_ORDERS + 1} entries")
        return tuple(self.poly(each, name) for each in given)

    def witness(self) -> dict[str, Fraction]:
        given = object_of(self.take("witness"), "witness")
        variables = {name for name in self.names if not name.startswith("#")}
        both = ", ".join(PLANE) if self.layout.single else "the coordinates"
        said = f"witness: gives values to {both} and the parameters: {', '.join(sorted(variables))}"
        need(not given or set(given) == variables, said)
        return {name: number_of(x, "witness") for name, x in given.items()}

    def cofactors(self) -> dict[str, dict[str, Poly]]:
        given = object_of(self.take("cofactors"), "cofactors")
        return {
            what: {name: self.poly(x, f"cofactors of {short(what)}") for name, x in each.items()}
            for what, each in ((key, object_of(x, "cofactors")) for key, x in given.items())
        }

    def poly(self, data: object, what: str) -> Poly:
        return poly_of(data, what, self._known)

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
