"""Named systems: Hamiltonians with their sources, and their motions in closed form if known.

`Motion` is the exact solution through one initial value, which a system's flow returns.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from flint import arb, fmpq

from verify.arithmetic.exact import Number, rational
from verify.errors import InputError
from verify.hamiltonians.coordinates import MAX_DEGREES, coordinates_of
from verify.hamiltonians.hamiltonian import Hamiltonian

Values = Mapping[str, Fraction]  # a system's parameters
State = tuple[arb, arb]  # p, q


@dataclass(frozen=True)
class Motion:
    """A motion t ↦ (p, q) through one initial value, in closed form and in balls.

    - `state(t)`, t ≠ 0: the state at time t.
    - `blow_up(sign)`: |t| at which the solution ends, forwards (1) or backwards (−1) in time; None
      if it does not end. The field is None if no solution of the system ends.
    - `goes()`: a text that says how the motion goes to infinity as t grows; None if it stays
      bounded, or blows up in a finite time.
    - `method`: a text for reports. `is_at_rest`: the motion stays at its start.

    Balls contain the true values. They are not finite if flint's precision does not suffice: the
    caller then raises the precision.
    """

    state: Callable[[arb], State]
    method: str
    blow_up: Callable[[int], arb | None] | None = None
    goes: Callable[[], str | None] = lambda: None
    is_at_rest: bool = False


def at_rest(p: Fraction, q: Fraction) -> Motion:
    """Return the motion that stays at an equilibrium."""
    return Motion(lambda _: (arb(exactly(p)), arb(exactly(q))), "at rest", is_at_rest=True)


def exactly(x: Fraction) -> fmpq:
    """Return x as a rational of flint."""
    return fmpq(x.numerator, x.denominator)


# (parameters, p, q) → motion; None if these parameters have no closed form.
ClosedFormFlow = Callable[[Values, Fraction, Fraction], Motion | None]
# (parameters, (p, q, t) at the start, time after it) → p and q.
ClosedFormFlowInTime = Callable[[Values, tuple[Fraction, Fraction, Fraction], Fraction], State]
Regime = Mapping[str, str]  # "p", "q" and every parameter, as exact text


@dataclass(frozen=True)
class System:
    """A Hamiltonian with a name.

    - `formula`: H(p, q), H(p, q, t), or H(p1, …, q1, …). `source`: where it is from.
    - `parameters`: an explanation of each parameter.
    - `flow`: the exact flow in closed form, if it is known; `flow_in_time` if H depends on time.
    - `goes`, for a system without a flow: (parameters, p, q) → how the orbit goes to infinity as t
      grows; None if it stays bounded.
    - `regimes`: examples of the kinds of orbits; in n degrees of freedom p and q are lists in them.
    - `family`, of a system for each n ≥ 2 degrees of freedom: n → formula. n is then among the
      `parameters`, and `formula` is used if n has no value.
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

        `values`: exact numbers, or texts of them, by name; n of a family is no symbol of H. Raises
        InputError as `Hamiltonian.parse` does, and if n is no whole number from 2 to 64.
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
        """The number of degrees of freedom; for a family that of `formula`."""
        # The text decides, so that a search for systems of the plane parses no others.
        return len(coordinates_of(re.findall(r"[a-zA-Z]\w*", self.formula))) // 2

    @property
    def has_closed_form(self) -> bool:
        """True if its exact flow is known in closed form."""
        return (self.flow or self.flow_in_time) is not None

    def regime(self, name: str) -> tuple[Values, Fraction, Fraction]:
        """Return the exact parameters by name, p and q of one of `regimes`, for a system of the
        plane. Raises KeyError for an unknown name."""
        # A regime has the initial p and q among its parameters.
        values = {key: rational(text, key) for key, text in self.regimes[name].items()}
        return values, values.pop("p"), values.pop("q")


def _whole_number(number: Number) -> int:
    """Return n of a family. Raises InputError unless it is a whole number in its range."""
    value = rational(number, "parameter n")
    if value.denominator != 1 or not 2 <= value <= MAX_DEGREES:
        raise InputError("parameter n", number, f"must be a whole number, 2 … {MAX_DEGREES}")
    return int(value)
