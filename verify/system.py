"""A named system: a Hamiltonian with its source."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from verify.exact import Exact
from verify.hamiltonian import Hamiltonian


@dataclass(frozen=True)
class System:
    """`formula` is H(p, q); `parameters` explains each of its parameters."""

    name: str
    title: str
    formula: str
    source: str
    parameters: Mapping[str, str] = field(default_factory=dict)

    def hamiltonian(self, values: Mapping[str, Exact | None] | None = None) -> Hamiltonian:
        """H with these parameter values; parameters without one stay symbols."""
        return Hamiltonian.parse(self.formula, values)
