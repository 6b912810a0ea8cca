"""The names that a certificate's polynomials are made of, and what every export of a map has."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any

from verify.proof.assistant.factors import known_power
from verify.proof.assistant.formulas import Spelling, form_list
from verify.proof.certificates.entries import Expansion, Form
from verify.proof.certificates.readers import PLANE, Poly


class Names(ABC):
    """How they are written: `deep`, as numbered names, and `shallow`, as a person does."""

    deep: Spelling
    shallow: Spelling
    zero: str  # as an entry of a form is where it has none

    def __init__(self, entries: Expansion) -> None:
        self.entries = entries
        self.coordinates = {name: k for k, name in enumerate((*entries.coordinates, "t"))}

    @abstractmethod
    def bound(self, polys: Iterable[Poly], text: str) -> str:
        """The text, in which the names that these have are bound to what they stand for."""

    def form(self, x: Form) -> str:
        """A 2-form as a person writes it."""
        if self.entries.layout.single:
            return self.bound(x.values(), self.shallow.poly(x.get(PLANE, {})))
        entries = self.bound(x.values(), form_list(x, self.coordinates, self.shallow))
        return f"entry {self.zero} ({entries})"

    def series(self, spelling: Spelling) -> str:
        """The coefficients of each coordinate's new value."""
        lists = ";\n   ".join(map(spelling.list, self.entries.after))
        return f"[{lists}]"

    def values(self) -> dict[str, Any]:
        """What a template is given of any map."""
        entries = self.entries
        return {
            "n": entries.layout.degrees,
            "planar": entries.layout.single,
            "agreement": entries.convergence_order,
            "known": known_power(entries),
            "order": entries.order,
        }

    def deep_values(self) -> dict[str, str]:
        """The same, of what stands in it as formulas in numbered names."""
        entries = self.entries
        return {
            "series": self.series(self.deep),
            "leading": form_list(entries.leading, self.coordinates, self.deep),
            "potential": form_list(entries.potential or {}, self.coordinates, self.deep),
        }


def polynomials_of(entries: Expansion) -> Iterator[Poly]:
    """H, where it is one, the map, L and G."""
    if entries.hamiltonian is not None:
        yield entries.hamiltonian
    for series in entries.after:
        yield from series
    yield from entries.leading.values()
    yield from (entries.potential or {}).values()
