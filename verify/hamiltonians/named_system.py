"""A named system: a Hamiltonian with its source, and its exact flow where that is known."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from verify.arithmetic.exact import Exact, rational
from verify.errors import InputError
from verify.hamiltonians.coordinates import MOST_DEGREES, coordinates_of
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.motion import Flow, State, Values

FlowInTime = Callable[[Values, tuple[Fraction, Fraction, Fraction], Fraction], State]
Regime = Mapping[str, str]  # "p", "q" and every parameter, as exact text


@dataclass(frozen=True)
class System:
    """A Hamiltonian with a name: `formula` is H(p, q), H(p, q, t), or H(p1, …, q1, …).

    `parameters` explains each of its parameters. `flow` is its exact flow in closed form, where
    that is known; of an H that depends on time, `flow_in_time` gives p and q for (parameters, p, q
    and t at the start, how long). Without one, `goes` may say of (parameters, p, q) how the orbit
    goes to infinity as t grows: None where it stays bounded. `regimes` are examples of the kinds of
    orbits that it has; in several degrees of freedom p and q are lists in them.

    A `family` is a system for each number n of degrees of freedom from 2 on: it gives the formula
    for n, which is among the `parameters`, and `formula` is that where n is not given.
    """

    name: str
    title: str
    formula: str
    source: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    flow: Flow | None = None
    flow_in_time: FlowInTime | None = None
    goes: Callable[[Values, Fraction, Fraction], str | None] | None = None
    regimes: Mapping[str, Regime] = field(default_factory=dict)
    family: Callable[[int], str] | None = None

    def __repr__(self) -> str:
        return f"System({self.name}: {self.formula})"

    def _repr_latex_(self) -> str:
        return self.hamiltonian()._repr_latex_()

    def hamiltonian(self, values: Mapping[str, Exact | None] | None = None) -> Hamiltonian:
        """Return H with these parameter values; parameters without one stay symbols.

        Of a family n is no symbol of H: InputError where it is no whole number, 2 … 64.
        """
        if self.family is None or not isinstance(values, Mapping):
            return Hamiltonian.parse(self.formula, values)
        size = values.get("n")
        formula = self.formula if size is None else self.family(_whole_number(size))
        return Hamiltonian.parse(formula, {n: x for n, x in values.items() if n != "n"})

    @property
    def time_dependent(self) -> bool:
        """True if t is in H."""
        return self.hamiltonian().time_dependent

    @property
    def degrees(self) -> int:
        """The number of degrees of freedom; of a family, that of `formula`."""
        # By the text alone, so that a search for systems of the plane parses no others.
        return len(coordinates_of(re.findall(r"[a-zA-Z]\w*", self.formula))) // 2

    @property
    def has_closed_form(self) -> bool:
        """True if its exact flow is known in closed form."""
        return (self.flow or self.flow_in_time) is not None

    def regime(self, name: str) -> tuple[Values, Fraction, Fraction]:
        """Return the parameters, p and q of an example."""
        # A regime has p and q of the start among its parameters.
        values = {key: rational(text, key) for key, text in self.regimes[name].items()}
        return values, values.pop("p"), values.pop("q")


def _whole_number(number: Exact) -> int:
    """Return n of a family; InputError unless it is a whole number in its range."""
    value = rational(number, "parameter n")
    if value.denominator != 1 or not 2 <= value <= MOST_DEGREES:
        raise InputError("parameter n", number, f"must be a whole number, 2 … {MOST_DEGREES}")
    return int(value)
