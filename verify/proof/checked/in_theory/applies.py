"""The statements of theorems of the shipped theory about schemes, as data."""

from collections.abc import Callable
from dataclasses import dataclass

from verify.proof.checked.proved import About, ProvedStatement
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.structures import AREA, SYMPLECTIC


@dataclass(frozen=True)
class Applies:
    """Some theorems of the theory, and the schemes to which they apply.

    `about`: the part of a proof that they confirm; `applies`: whether they apply to a scheme and H;
    `theorems`: their names, as FILE.NAME; `says`: their statement, as `read_prose` takes it.

    In the plane `in_plane` takes the place of `theorems`, if there are any. A `symplectic` map
    preserves area there, by one more theorem, and `so` is added to the statement.
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
        more = ("Theorems.symplectic_is_area_preserving",) * self.symplectic
        in_plane = (*(self.in_plane or self.theorems), *more)
        # A map of the plane may be covered by a theorem of its own, or by the general one together
        # with the theorem that a symplectic map preserves area there.
        return {AREA: in_plane, SYMPLECTIC: self.theorems}[proved.structure]

    def sentence(self, proved: ProvedStatement) -> str:
        """Return the theorems' statement about the scheme."""
        return self.says(proved) + {AREA: self.so, SYMPLECTIC: ""}[proved.structure]


def eta_of(proved: ProvedStatement) -> int | None:
    """Return η for lieη, the flow's truncated series; None for any other scheme."""
    every_h = proved.scheme.every_h
    return every_h.eta if isinstance(every_h, TaylorSeries) else None


def is_lie(proved: ProvedStatement) -> bool:
    """Return True if the scheme is lieη and preserves nothing for this H."""
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
