"""What some theorems of the shipped theory say of schemes, as data."""

from collections.abc import Callable
from dataclasses import dataclass

from verify.proof.assistant.stated import Shipped
from verify.proof.checked.proved import About, Proved
from verify.schemes.conditions.every_hamiltonian import TaylorSeries


@dataclass(frozen=True)
class Applies:
    """`about`: what of a proof they say again; `applies`: of which schemes and H; `theorems`: those
    by which; `says`: what they say there, as `read_prose` takes it."""

    about: About
    applies: Callable[[Proved], bool]
    theorems: Callable[[Proved], tuple[Shipped, ...]]
    says: Callable[[Proved], str]


def eta_of(proved: Proved) -> int | None:
    """The η of a scheme that is the flow's series, cut off; None of any other."""
    every_h = proved.scheme.every_h
    return every_h.eta if isinstance(every_h, TaylorSeries) else None


def for_every(proved: Proved) -> str:
    """For which H they hold, in words."""
    degrees = "" if proved.planar else f" of {proved.degrees} degrees of freedom"
    return f"for every smooth H{'(p, q, t)' * proved.timed}{degrees}"
