"""The content of a proof about a scheme, in the form that the marks of checkers use."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.proof.certificates.certificate_file import Certificate
from verify.proof.certificates.certification import certify_for_every_h, certify_for_one_h
from verify.proof.order_for_every_h import prove_for_every_h
from verify.proof.plane.potential import Potential
from verify.proof.proof_for_every_h import ProofForEveryH
from verify.proof.proof_for_one_h import Proof
from verify.schemes.scheme import Scheme
from verify.structures import CanonicalForm, structure_in

About = Literal["defect", "volume", "map", "telescopes", "product"]
DEFECT: frozenset[About] = frozenset({"defect"})
MAP: frozenset[About] = frozenset({"map"})
ALL: frozenset[About] = frozenset({"defect", "map", "telescopes"})
_NOT_LOOKED_FOR = Potential(None, "is not looked for")
_LONGEST_LEADING = 25_000  # characters; a certificate up to it takes under half a second


@dataclass(frozen=True)
class ProvedStatement:
    """A proof about a scheme, and the parts of it whose checkers are sought.

    - `about`: the parts. `defect`: the order of ΔJ, in n degrees of freedom of S, or that it is 0.
      `volume`: the order of det J − 1 in n degrees of freedom. `map`: the order of the map.
      `telescopes`: whether the leading coefficient telescopes. `product`: the bound of Λ by small
      ΔJ.
    - `preserves`: True if ΔJ ≡ 0, or S ≡ 0; None if undecided.
    - `for_every_h`: True if the proof is for every H, False if for one.
    - `timed`: True if H depends on time.
    - `certificates`: functions that write a certificate of the proof, tried in turn; empty if that
      would take long.
    """

    scheme: Scheme
    about: frozenset[About]
    preserves: bool | None
    for_every_h: bool
    timed: bool
    degrees: int
    certificates: tuple[Callable[[], Certificate], ...] = ()

    @property
    def structure(self) -> CanonicalForm:
        """The structure that a canonical step preserves: area, or the symplectic form."""
        return structure_in(self.degrees)


def statement_for_every_h(
    proof: ProofForEveryH, scheme: Scheme, about: frozenset[About]
) -> ProvedStatement:
    """Return the content of a proof for every H, with the parts it is `about`."""
    short = len(proof.leading) <= _LONGEST_LEADING
    return ProvedStatement(
        scheme, _parts_in_plane(about, proof.degrees), proof.symplectic, for_every_h=True,
        timed=proof.timed, degrees=proof.degrees,
        certificates=(lambda: certify_for_every_h(proof),) if short else (),
    )  # fmt: skip


def statement_for_one_h(
    proof: Proof,
    hamiltonian: Hamiltonian,
    scheme: Scheme,
    about: frozenset[About],
) -> ProvedStatement:
    """Return the content of a proof for one H, with the parts it is `about`.

    If there is no certificate for this map, that for every H serves if the map is symplectic.
    """
    timed, degrees = hamiltonian.time_dependent, hamiltonian.degrees

    def certificate_for_this() -> Certificate:
        return certify_for_one_h(proof, _NOT_LOOKED_FOR)

    def certificate_for_every() -> Certificate:
        return certify_for_every_h(prove_for_every_h(scheme.name, timed=timed, degrees=degrees))

    # For a symplectic map the statement is S = 0, which the certificate for every H implies.
    fallback = proof.symplectic and scheme.every_h is not None
    short = proof.symplectic or len(proof.leading_text) <= _LONGEST_LEADING
    return ProvedStatement(
        scheme, _parts_in_plane(about, degrees), proof.symplectic, for_every_h=False,
        timed=timed, degrees=degrees,
        certificates=(
            (certificate_for_this, *(certificate_for_every,) * bool(fallback)) if short else ()
        ),
    )  # fmt: skip


def _parts_in_plane(about: frozenset[About], degrees: int) -> frozenset[About]:
    """Return `about`, in the plane with `defect` in place of `volume`, as S is ΔJ dp∧dq there."""
    return (about - {"volume"}) | DEFECT if degrees == 1 and "volume" in about else about
