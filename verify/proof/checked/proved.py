"""What a proof says of a scheme, as those ask for it that say who checked it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.every import of_every
from verify.proof.certificates.file import Certificate
from verify.proof.certificates.one import of_one
from verify.proof.every import prove_every
from verify.proof.every_proof import EveryProof
from verify.proof.plane.potential import Potential
from verify.proof.proof import Proof
from verify.schemes.scheme import Scheme
from verify.structures import Structure, structure_in

About = Literal["defect", "volume", "map", "telescopes", "product"]
DEFECT: frozenset[About] = frozenset({"defect"})
MAP: frozenset[About] = frozenset({"map"})
ALL: frozenset[About] = frozenset({"defect", "map", "telescopes"})
_NOT_LOOKED_FOR = Potential(None, "is not looked for")
_LONGEST = 25_000  # characters of a leading coefficient whose certificate takes under half a second


@dataclass(frozen=True)
class Proved:
    """What is proved of a scheme, and what of it is asked about.

    `about`: the order of ΔJ (of S in n degrees of freedom) or that it is 0, `defect`; in n degrees
    of freedom that of det J − 1, `volume`; the order of the `map`; whether the leading coefficient
    `telescopes`; what small ΔJ make of Λ, `product`. `preserves`: whether ΔJ ≡ 0, or S ≡ 0.
    `every`: for every H, else for one. `timed`: H depends on time. `certificates`: what makes a
    certificate of it, each tried after the one before; none where it would take long.
    """

    scheme: Scheme
    about: frozenset[About]
    preserves: bool | None
    every: bool
    timed: bool
    degrees: int
    certificates: tuple[Callable[[], Certificate], ...] = ()

    @property
    def structure(self) -> Structure:
        """What a canonical step of it keeps."""
        return structure_in(self.degrees)


def of_every_hamiltonian(proof: EveryProof, scheme: Scheme, about: frozenset[About]) -> Proved:
    """By a proof for every H."""
    short = len(proof.leading) <= _LONGEST
    return Proved(
        scheme, _asked(about, proof.degrees), proof.symplectic, every=True, timed=proof.timed,
        degrees=proof.degrees,
        certificates=(lambda: of_every(proof),) if short else (),
    )  # fmt: skip


def of_one_hamiltonian(
    proof: Proof,
    hamiltonian: Hamiltonian,
    scheme: Scheme,
    about: frozenset[About],
) -> Proved:
    """By a proof for this H.

    Where its own map has no certificate, that of every H tells as much if the map is symplectic.
    """
    timed, degrees = hamiltonian.time_dependent, hamiltonian.degrees

    def own() -> Certificate:
        return of_one(proof, _NOT_LOOKED_FOR)

    def every() -> Certificate:
        return of_every(prove_every(scheme.name, timed=timed, degrees=degrees))

    fallback = proof.symplectic and scheme.every_h is not None
    short = proof.symplectic or len(proof.leading_text) <= _LONGEST
    return Proved(
        scheme, _asked(about, degrees), proof.symplectic, every=False, timed=timed, degrees=degrees,
        certificates=(own, *(every,) * bool(fallback)) if short else (),
    )  # fmt: skip


def _asked(about: frozenset[About], degrees: int) -> frozenset[About]:
    """In the plane S is ΔJ, and one certificate tells of both."""
    return (about - {"volume"}) | DEFECT if degrees == 1 and "volume" in about else about
