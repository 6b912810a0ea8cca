"""The marks of Rocq: theorems of the shipped theory that state what is proved about a scheme.

A file in `statements/` has an `APPLIES`, which says to which schemes some theorems apply. Rocq does
not run for a mark: the tests check that `coqc` accepts the theory. Here it is only checked that the
theory states theorems of these names.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import get_args

from verify.discovery import Catalogue
from verify.proof.assistant.shipped_theory import cite_theorems
from verify.proof.checked.proved_statement import About, ProvedStatement
from verify.prose import Prose, prose, read_prose
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.structures import AREA, SYMPLECTIC

_FILES = Catalogue(f"{__package__}.statements", [f"{Path(__file__).parent}/statements"])


@dataclass(frozen=True)
class Applies:
    """Some theorems of the theory, and the schemes to which they apply.

    - `about`: the part of a proof that they confirm.
    - `applies`: True for the schemes and H to which they apply.
    - `theorems`: their names, as FILE.NAME; `in_plane`: the names in the plane, if others.
    - `says`: their statement about a scheme, as `read_prose` takes it.
    - `symplectic`: True if they state S = 0. In the plane one more theorem then says that area is
      preserved, and `so` is appended to the statement.
    """

    about: About
    applies: Callable[[ProvedStatement], bool]
    theorems: tuple[str, ...]
    says: Callable[[ProvedStatement], str]
    in_plane: tuple[str, ...] = ()
    symplectic: bool = False
    so: str = ""

    def names(self, proved: ProvedStatement) -> tuple[str, ...]:
        """Return the names of the theorems that apply to the proof's structure."""
        plane_theorem = ("Theorems.symplectic_is_area_preserving",) * self.symplectic
        in_plane = (*(self.in_plane or self.theorems), *plane_theorem)
        # In the plane the theorems are those of the plane, or the general ones together with the
        # one that a symplectic map of the plane preserves area.
        return {AREA: in_plane, SYMPLECTIC: self.theorems}[proved.structure]

    def sentence(self, proved: ProvedStatement) -> str:
        """Return the theorems' statement about the scheme."""
        return self.says(proved) + {AREA: self.so, SYMPLECTIC: ""}[proved.structure]


@cache
def all_statements() -> tuple[Applies, ...]:
    """Return the `APPLIES` of each file, ordered by the part of a proof that it is about."""
    statements = (_FILES.module(file).APPLIES for file in _FILES.names)
    return tuple(sorted(statements, key=lambda statement: get_args(About).index(statement.about)))


def theory_marks(proved: ProvedStatement) -> Iterator[Prose]:
    """Yield, for each statement that applies, the theorems' names and their sentence."""
    for statement in all_statements():
        names = statement.names(proved)
        if names and statement.about in proved.about and statement.applies(proved):
            yield prose(cite_theorems(names), ": ", read_prose(statement.sentence(proved)))


# -- texts of several statements ------------------------------------------------------------------


def eta_of(proved: ProvedStatement) -> int | None:
    """Return η for lieη, the flow's truncated series; None for any other scheme."""
    every_h = proved.scheme.every_h
    return every_h.eta if isinstance(every_h, TaylorSeries) else None


def is_lie(proved: ProvedStatement) -> bool:
    """Return True if the scheme is lieη and the defect is not shown to be 0."""
    return eta_of(proved) is not None and proved.preserves is not True


def for_every(proved: ProvedStatement) -> str:
    """Name the class of H for which the theorems hold, in words."""
    degrees = {AREA: "", SYMPLECTIC: f" of {proved.degrees} degrees of freedom"}[proved.structure]
    return f"for every smooth H{'(p, q, t)' * proved.timed}{degrees}"


def by_flow(proved: ProvedStatement) -> str:
    """Return the letter for the derivative along the flow: D with time, else X."""
    return "D" if proved.timed else "X"


def first_term(proved: ProvedStatement, defect: str, coefficient: str) -> str:
    """State that the defect of lieη begins with h^(η+1), and with which coefficient."""
    power = f"`h^{(eta_of(proved) or 0) + 1}`"
    has = f"has no term below {power}, and that with {power} has the coefficient {coefficient}"
    return f"{for_every(proved)} {defect} {has}"


def divergence(proved: ProvedStatement) -> str:
    """Format the leading coefficient of lieη's det J − 1."""
    eta = eta_of(proved) or 0
    return f"−div(`{by_flow(proved)}^{eta}` f)/{eta + 1}!"
