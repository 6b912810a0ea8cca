"""The names in a certificate's polynomials, and the parts common to all exports of a map."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from typing import Any

from verify.proof.assistant.factors import last_checked_power
from verify.proof.assistant.formulas import Spelling, form_list
from verify.proof.certificates.entries import Expansion, Form
from verify.proof.certificates.readers import PLANE, Poly


class Names(ABC):
    """The spellings of names: `deep`, as numbered names, and `shallow`, as a person writes."""

    deep: Spelling
    shallow: Spelling
    zero: str  # as an entry of a form is where it has none

    def __init__(self, entries: Expansion) -> None:
        self.entries = entries
        self.coordinates = {name: k for k, name in enumerate((*entries.coordinates, "t"))}

    @abstractmethod
    def bound(self, polys: Iterable[Poly], text: str) -> str:
        """Bind the names in these polynomials to what they stand for, around the text."""

    def form(self, x: Form) -> str:
        """Format a 2-form as a person writes it."""
        if self.entries.layout.single:
            return self.bound(x.values(), self.shallow.poly(x.get(PLANE, {})))
        entries = self.bound(x.values(), form_list(x, self.coordinates, self.shallow))
        return f"entry {self.zero} ({entries})"

    def series(self, spelling: Spelling) -> str:
        """Format the coefficients of each coordinate's new value."""
        lists = ";\n   ".join(map(spelling.list, self.entries.after))
        return f"[{lists}]"

    def values(self) -> dict[str, Any]:
        """Return the template's variables for any map."""
        entries = self.entries
        return {
            "n": entries.layout.degrees,
            "planar": entries.layout.single,
            "agreement": entries.convergence_order,
            # The template's name for the last power of h that the theory checks.
            "known": last_checked_power(entries),
            "order": entries.order,
        }

    def deep_values(self) -> dict[str, str]:
        """Return the template's variables that are formulas in numbered names."""
        entries = self.entries
        return {
            "series": self.series(self.deep),
            "leading": form_list(entries.leading, self.coordinates, self.deep),
            "potential": form_list(entries.potential or {}, self.coordinates, self.deep),
        }


def polynomials_of(entries: Expansion) -> Iterator[Poly]:
    """Yield all polynomials of a certificate: H, if it is for one H, the map, L and G."""
    if entries.hamiltonian is not None:
        yield entries.hamiltonian
    for series in entries.after:
        yield from series
    yield from entries.leading.values()
    yield from (entries.potential or {}).values()
