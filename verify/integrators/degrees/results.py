"""What was found of a step of arrays, held to what is claimed of it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from verify.algebra.domain import EVERYWHERE, Domain
from verify.integrators.maps.check import MapFinding
from verify.integrators.results import Claims, agreement_told
from verify.proof.symplectic.proof import SymplecticProof
from verify.prose import Prose, prose, read_prose
from verify.verdict import Verdict


@dataclass(frozen=True)
class StepFinding:
    """What was found of a step of arrays.

    `how`: "proof", "duals", "floats", or "calls" where the function was only called.

    `proof`: what is proved. `convergence_order`: that of the map, None where it is not known
    (`order_known` False) or agrees in all that was looked at. `measured`: S at points, with the
    step size `h`, where there is no proof.
    """

    verdict: Verdict
    reason: Prose
    how: str
    degrees: int
    proof: SymplecticProof | None = None
    symplectic: bool | None = None
    area_preserving: bool | None = None
    convergence_order: int | None = None
    order_known: bool = False
    measured: MapFinding | None = None
    h: Fraction | None = None
    domain: Domain = EVERYWHERE
    notes: tuple[Prose, ...] = ()

    def __repr__(self) -> str:
        return f"StepFinding({self.verdict}: {self.reason})"

    def noting(self, *parts: str | Prose) -> "StepFinding":
        """The same with one more note, first."""
        return replace(self, notes=(prose(*parts), *self.notes))


def held_to(claims: Claims, found: StepFinding) -> StepFinding:
    """REFUTED where a claim is, UNDECIDED where one is not decided.

    A step that is not symplectic is no mistake unless it is claimed to be.
    """
    told = list(_judged(claims, found))
    false = [said for holds, said in told if holds is False]
    open_ = [said for holds, said in told if holds is None]
    if found.verdict is Verdict.REFUTED and found.how != "proof" and _is_scheme(found):
        found = replace(found, verdict=Verdict.MEASURED)  # that it is not symplectic
    if false:
        return replace(found, verdict=Verdict.REFUTED, reason=read_prose(false[0]))
    if open_ and found.verdict is not Verdict.REFUTED:
        said = read_prose(f"{open_[0]} is claimed and not decided: ")
        return replace(found, verdict=Verdict.UNDECIDED, reason=prose(said, found.reason))
    return found


def _is_scheme(found: StepFinding) -> bool:
    """Whether nothing is known against its order."""
    return not found.order_known or found.convergence_order is None or found.convergence_order >= 1


def _judged(claims: Claims, found: StepFinding) -> Iterator[tuple[bool | None, str]]:
    """Each claim that does not hold: whether it is refuted, and what is said."""
    proof, agreed = found.proof, found.convergence_order
    if claims.order is not None:
        claim = f"order {claims.order}"
        if not found.order_known:
            yield None, claim
        elif agreed is not None and agreed < claims.order:
            yield False, f"{claim} is claimed; {agreement_told(agreed)}"
    if claims.symplectic and found.symplectic is not True:
        where = f"S has order {proof.order}" if proof and proof.order else "S is not 0"
        claim = "that it is symplectic"
        yield (
            found.symplectic,
            claim if found.symplectic is None else f"{claim} is claimed; {where}",
        )
    if claims.area_preserving and found.area_preserving is not True:
        power = proof.volume_order if proof else None
        where = f"det J − 1 has order {power}" if power else "det J is not 1"
        known = "det J ≡ 1"
        yield (
            found.area_preserving,
            known if found.area_preserving is None else (f"{known} is claimed; {where}"),
        )
    if claims.area_order is not None and not found.area_preserving:
        claim, power = f"ΔJ = O(`h^{claims.area_order}`)", proof.volume_order if proof else None
        if power is None:
            yield None, claim
        elif power < claims.area_order:
            yield False, f"{claim} is claimed; det J − 1 has order {power}"
