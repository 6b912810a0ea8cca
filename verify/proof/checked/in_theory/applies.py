"""What some theorems of the shipped theory say of schemes, as data."""

from collections.abc import Callable
from dataclasses import dataclass

from verify.proof.checked.proved import About, Proved
from verify.schemes.conditions.every_hamiltonian import TaylorSeries
from verify.structures import AREA, SYMPLECTIC


@dataclass(frozen=True)
class Applies:
    """`about`: what of a proof they say again; `applies`: of which schemes and H; `theorems`: those
    by which, as FILE.NAME; `says`: what they say there, as `read_prose` takes it.

    In the plane `in_plane` stand in their place, where there are any, alone where `theorems` are
    none; what is `symplectic` keeps area there, by one theorem more, and `so` is said.
    """

    about: About
    applies: Callable[[Proved], bool]
    theorems: tuple[str, ...]
    says: Callable[[Proved], str]
    in_plane: tuple[str, ...] = ()
    symplectic: bool = False
    so: str = ""

    def names(self, proved: Proved) -> tuple[str, ...]:
        """Of the theorems, for what is proved."""
        more = ("Theorems.symplectic_is_area_preserving",) * self.symplectic
        in_plane = (*(self.in_plane or self.theorems), *more)
        return {AREA: in_plane, SYMPLECTIC: self.theorems}[proved.structure]

    def sentence(self, proved: Proved) -> str:
        """What they say."""
        return self.says(proved) + {AREA: self.so, SYMPLECTIC: ""}[proved.structure]


def eta_of(proved: Proved) -> int | None:
    """The η of a scheme that is the flow's series, cut off; None of any other."""
    every_h = proved.scheme.every_h
    return every_h.eta if isinstance(every_h, TaylorSeries) else None


def is_lie(proved: Proved) -> bool:
    """Whether it is of lieη, which preserves nothing for this H."""
    return eta_of(proved) is not None and proved.preserves is not True


def for_every(proved: Proved) -> str:
    """For which H they hold, in words."""
    degrees = {AREA: "", SYMPLECTIC: f" of {proved.degrees} degrees of freedom"}[proved.structure]
    return f"for every smooth H{'(p, q, t)' * proved.timed}{degrees}"


def by_flow(proved: Proved) -> str:
    """The derivative along the flow."""
    return "D" if proved.timed else "X"


def first_term(proved: Proved, defect: str, coefficient: str) -> str:
    """That the defect of lieη begins with h^(η+1), and with which coefficient."""
    power = f"`h^{(eta_of(proved) or 0) + 1}`"
    has = f"has no term below {power}, and that with {power} has the coefficient {coefficient}"
    return f"{for_every(proved)} {defect} {has}"


def divergence(proved: Proved) -> str:
    """The leading coefficient of lieη's det J − 1."""
    eta = eta_of(proved) or 0
    return f"−div(`{by_flow(proved)}^{eta}` f)/{eta + 1}!"
