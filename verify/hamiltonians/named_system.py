"""A named system: a Hamiltonian with its source, and its motion in closed form where that is known.

`Motion` is the exact solution through one initial value, as a system's flow provides it.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from flint import arb, fmpq

from verify.arithmetic.exact import Number, rational
from verify.errors import InputError
from verify.hamiltonians.coordinates import MOST_DEGREES, coordinates_of
from verify.hamiltonians.hamiltonian import Hamiltonian

Values = Mapping[str, Fraction]  # a system's parameters
State = tuple[arb, arb]  # p, q


@dataclass(frozen=True)
class Motion:
    """t ↦ (p, q) through one initial value, in closed form and in balls.

    `state(t)`, t ≠ 0, and `blow_up(sign)` hold the true values, or are not finite, where flint's
    precision does not suffice: the caller then raises it. `blow_up`: |t| where the solution ends,
    forwards (1) or backwards (−1) in time, None where it does not; itself None where no such
    solution does. `goes()`: how it goes to infinity as t grows, where it does so without an end;
    None where it stays bounded or blows up. `is_at_rest`: it stays at its start.
    """

    state: Callable[[arb], State]
    method: str
    blow_up: Callable[[int], arb | None] | None = None
    goes: Callable[[], str | None] = lambda: None
    is_at_rest: bool = False


def at_rest(p: Fraction, q: Fraction) -> Motion:
    """Return the motion that stays at an equilibrium."""
    return Motion(lambda _: (arb(exactly(p)), arb(exactly(q))), "at rest", is_at_rest=True)


# (parameters, (p, q, t) at the start, how long) ↦ p and q.


def exactly(x: Fraction) -> fmpq:
    """Return flint's rational."""
    return fmpq(x.numerator, x.denominator)


# (parameters, p, q) ↦ the motion; None where these parameters have no closed form.
ClosedFormFlow = Callable[[Values, Fraction, Fraction], Motion | None]
ClosedFormFlowInTime = Callable[[Values, tuple[Fraction, Fraction, Fraction], Fraction], State]
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
    flow: ClosedFormFlow | None = None
    flow_in_time: ClosedFormFlowInTime | None = None
    goes: Callable[[Values, Fraction, Fraction], str | None] | None = None
    regimes: Mapping[str, Regime] = field(default_factory=dict)
    family: Callable[[int], str] | None = None

    def __repr__(self) -> str:
        return f"System({self.name}: {self.formula})"

    def _repr_latex_(self) -> str:
        return self.hamiltonian()._repr_latex_()

    def hamiltonian(self, values: Mapping[str, Number | None] | None = None) -> Hamiltonian:
        """Return H with these parameter values; parameters without one stay symbols.

        `values`: exact numbers, or texts of them, by name. Of a family n is no symbol of H. Raises
        InputError as `Hamiltonian.parse` does, and for an n that is no whole number, 2 … 64.
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
        """Return the parameters by their names, p and q of an example, one of `regimes`, exactly.

        Of systems of the plane; raises KeyError for a name that is none of them.
        """
        # A regime has p and q of the start among its parameters.
        values = {key: rational(text, key) for key, text in self.regimes[name].items()}
        return values, values.pop("p"), values.pop("q")


def _whole_number(number: Number) -> int:
    """Return n of a family; InputError unless it is a whole number in its range."""
    value = rational(number, "parameter n")
    if value.denominator != 1 or not 2 <= value <= MOST_DEGREES:
        raise InputError("parameter n", number, f"must be a whole number, 2 … {MOST_DEGREES}")
    return int(value)
