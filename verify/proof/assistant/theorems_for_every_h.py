"""The export of a certificate for every H, for any ring with commuting derivations."""

from collections.abc import Iterable, Iterator

from verify.proof.assistant.nonzero_witness import energy_that_shows
from verify.proof.assistant.rocq_formulas import (
    Names,
    Spelling,
    deep,
    list_of,
    polynomials_of,
    rational,
    whole,
)
from verify.proof.assistant.text import Export
from verify.proof.certificates.entries import Expansion, derived_by
from verify.proof.certificates.readers import Poly

_NEEDS = [
    "Rings",
    "Totals",
    "Flow",
    "Taylor",
    "Bracket",
    "Formulas",
    "Identities",
    "EveryHamiltonian",
    "EveryClaims",
    "EveryNumbers",
    "Differential",
    "Smooth",
    "Systems",
    "RealMaps",
    "EverySmooth",
]
_HAMILTONIANS = {  # the class of H, by (separable, timed)
    (False, False): "H(p, q)",
    (True, False): "H = T(p) + V(q)",
    (False, True): "H(p, q, t)",
    (True, True): "H = T(p, t) + V(q, t)",
}
_SHALLOW = Spelling(
    number=lambda c: f"rational {rational(c)}",
    name=lambda name: name,
    power=lambda base, n: f"{base} ^ {n}",
)


def export_for_every_h(entries: Expansion) -> Export:
    """Export the theorems of a certificate for every H, and their proofs."""
    names, order, potential = _RingNames(entries), entries.order, entries.potential
    witness, length = energy_that_shows(entries), entries.length
    return Export(
        needs=_NEEDS if witness is None else (*_NEEDS, "EveryNonzero"),
        template="every",
        of_rings=True,
        shows_nonzero=order is None or witness is not None,
        values={
            **names.values(),
            "which": _HAMILTONIANS[entries.separable, entries.timed],
            "timed": whole(entries.timed),
            "separable": whole(entries.separable),
            "coordinates": " ".join(f"let {x} := {k} in" for x, k in names.coordinates.items()),
            "derivatives": list_of(map(list_of, names.derived_by_name)),
            "maps": [
                {
                    "coordinate": name,
                    "name": f"{name}_next",
                    "coefficients": names.bound(series, _SHALLOW.list(series)),
                }
                for name, series in zip(entries.coordinates, entries.after, strict=True)
            ],
            "length": length,
            "left": max(0, 2 * length - order - 2) if order else None,
            "shown": witness
            and {
                "entry": tuple(names.coordinates[x] for x in witness.entry),
                "energy": names.deep.format_scoped(witness.energy),
                "point": list_of(rational(witness.point[x]) for x in names.coordinates),
            },
            "leading": names.form(entries.leading),
            "potential": None if potential is None else names.form(potential),
            "deep": names.deep_values(),
        },
    )


class _RingNames(Names):
    """The names of the coordinates and of the derivatives of H."""

    shallow, zero = _SHALLOW, "(rational 0)"

    def __init__(self, entries: Expansion) -> None:
        super().__init__(entries)
        self.n = entries.layout.degrees
        used_names = {name for x in polynomials_of(entries) for names in x for name in names}
        derived = {self._index(name) for name in used_names if name not in self.coordinates}
        # The check differentiates the formulas once and H twice, and needs names for the results.
        derived |= {(k,) for k in range(2 * self.n)}
        self.derived = sorted(derived | set(self._slopes(derived)), key=lambda x: (len(x), x))
        letters = list(self.coordinates)
        self.derived_by_name = [[letters[k] for k in index] for index in self.derived]
        numbers = {name: k + 1 for name, k in self.coordinates.items()}
        numbers |= {self._name(x): len(numbers) + k for k, x in enumerate(self.derived, start=1)}
        self.deep = deep(numbers)

    def bound(self, polys: Iterable[Poly], text: str) -> str:
        used_names = {name for x in polys for names in x for name in names}
        plain = [name for name in self.coordinates if name in used_names]
        derived = sorted((self._index(x) for x in used_names - {*plain}), key=lambda x: (len(x), x))
        bound = [f"let {x} := coordinate s {self.coordinates[x]} in" for x in plain]
        if derived:
            # Rocq expands each `let`, so that only names that occur are bound.
            bound.append("let H := hamiltonian s in")
        for index in derived:
            slopes = " (".join(f"by_coordinate {k}" for k in index)
            bound.append(f"let {self._name(index)} := {slopes} H{')' * (len(index) - 1)} in")
        return "\n  ".join([*bound, text])

    def _index(self, name: str) -> tuple[int, ...]:
        """Return the numbers of the variables by which H is differentiated, in order."""
        return tuple(sorted(self.coordinates[coordinate] for coordinate in derived_by(name)))

    def _name(self, index: tuple[int, ...]) -> str:
        letters = list(self.coordinates)
        return "H_" + "".join(letters[k] for k in index)

    def _slopes(self, derived: Iterable[tuple[int, ...]]) -> Iterator[tuple[int, ...]]:
        """Yield the derivatives of these by one more variable, without those that are 0."""
        for index in derived:
            for coordinate in range(2 * self.n + self.entries.timed):
                longer = tuple(sorted((*index, coordinate)))
                mixed = min(longer) < self.n and any(self.n <= k < 2 * self.n for k in longer)
                if not (self.entries.separable and mixed):
                    yield longer
