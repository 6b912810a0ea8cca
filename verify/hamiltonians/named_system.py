"""A named system: a Hamiltonian with its source, and what is known of its exact flow."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from verify.arithmetic.exact import Exact, rational
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.motion import Flow, State, Values

FlowInTime = Callable[[Values, tuple[Fraction, Fraction, Fraction], Fraction], State]
Regime = Mapping[str, str]  # "p", "q" and every parameter, as exact text


@dataclass(frozen=True)
class System:
    """`formula` is H(p, q), H(p, q, t), or H(p1, …, q1, …).

    `parameters` explains each of its parameters.
    `flow` is its exact flow in closed form, where that is known; of an H that depends on time,
    `flow_in_time` gives p and q for (parameters, p, q and t at the start, how long). Without one,
    `goes` may say of (parameters, p, q) how the orbit goes to infinity as t grows: None where it
    stays bounded. `regimes` are examples of the kinds of orbits that it has; in several degrees of
    freedom p and q are lists in them.
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

    def __repr__(self) -> str:
        return f"System({self.name}: {self.formula})"

    def _repr_latex_(self) -> str:
        return self.hamiltonian()._repr_latex_()

    def hamiltonian(self, values: Mapping[str, Exact | None] | None = None) -> Hamiltonian:
        """H with these parameter values; parameters without one stay symbols."""
        return Hamiltonian.parse(self.formula, values)

    @property
    def time_dependent(self) -> bool:
        """Whether t is in H."""
        return self.hamiltonian().time_dependent

    @property
    def degrees(self) -> int:
        """Of freedom."""
        return self.hamiltonian().degrees

    @property
    def has_closed_form(self) -> bool:
        """Whether its exact flow is known in closed form."""
        return (self.flow or self.flow_in_time) is not None

    def regime(self, name: str) -> tuple[Values, Fraction, Fraction]:
        """The parameters, p and q of an example."""
        values = {key: rational(text, key) for key, text in self.regimes[name].items()}
        return values, values.pop("p"), values.pop("q")
