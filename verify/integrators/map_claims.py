"""What may be claimed of a map without a flow: the system of its names, and checks of claims."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction

import sympy

from verify.algebra.formula import FUNCTIONS, symbol
from verify.errors import InputError
from verify.hamiltonians.coordinates import coordinates_in
from verify.structures.conformal import Conformal
from verify.structures.reading import ClaimedStructure, KeepsRequest, read_structures
from verify.structures.symmetric import Symmetric
from verify.structures.symplectic import SymplecticForm


def coordinates_from(text: str, source: str = "coordinates") -> tuple[str, ...]:
    """Return the names of coordinates, which commas separate. Raises InputError, on `source`."""
    names = tuple(name.strip() for name in text.split(","))
    for name in names:
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,31}", name, re.ASCII):
            raise InputError(source, text, f"{name!r} is no name")
        if name in ("h", "t", "pi", *FUNCTIONS) or names.count(name) > 1:
            problem = "stands twice" if names.count(name) > 1 else "has another meaning"
            raise InputError(source, text, f"{name} {problem}")
    return names


@dataclass(frozen=True)
class MapSystem:
    """The system of a map without a flow: the names in the formulas of what it may keep.

    `parameters`: further arguments with their values. It is `canonical` if its coordinates are p
    and q, or p1 … pn, q1 … qn.
    """

    coordinates: tuple[str, ...]
    values: Mapping[str, Fraction] = field(default_factory=dict)
    time_dependent: bool = False
    energy: None = None

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the further arguments."""
        return tuple(self.values)

    @property
    def canonical(self) -> bool:
        """True if the coordinates are those of a Hamiltonian."""
        return self.coordinates == coordinates_in(max(len(self.coordinates) // 2, 1))

    def read(self, request: KeepsRequest) -> list[ClaimedStructure]:
        """Return the structures that are asked for; volume, if none is."""
        claims = read_structures(request or KeepsRequest(keeps=("volume",)), self)
        values = {symbol(n): sympy.Rational(x.numerator, x.denominator)
                  for n, x in self.values.items()}  # fmt: skip
        return [replace(x, structure=x.structure.with_values(values)) for x in claims]


def check_map_claim(claim: ClaimedStructure, names: tuple[str, ...]) -> None:
    """Raise InputError unless the formulas make a structure that a map may have."""
    structure = claim.structure
    if claim.order is not None:
        raise InputError("--keeps", f"{structure.label}: {claim.order}", "a map has no h")
    if isinstance(structure, Symmetric):
        raise InputError("--keeps", "symmetric", "is of steps; a map has no h")
    if isinstance(structure, Conformal):
        if any(x.name == "h" for x in structure.factor.free_symbols):
            problem = "has h, and a map has none; give its value as --param h=…, or the number"
            raise InputError("--factor", str(structure.factor), problem)
        mistake = SymplecticForm("conformal", "", structure.entries).mistake(names)
    else:
        mistake = structure.mistake(names)
    if mistake:
        raise InputError("--keeps", structure.label, mistake)
