"""The finding on a user's step or map, and the claims that it is judged by."""

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import NamedTuple

from verify.algebra.domain import EVERYWHERE, FormulaDomain
from verify.integrators.measures.reading import DefectReading
from verify.integrators.measures.way_back import WayBack
from verify.integrators.places.trial_places import TrialPlace
from verify.proof.plane.potential import Potential, potential_of
from verify.proof.proof_for_one_h import Proof
from verify.prose import Prose, prose, read_prose
from verify.structures import Structure, structure_in
from verify.verdict import Verdict

MOST_CLAIMED = 12


@dataclass(frozen=True)
class Claims:
    """The claims that a step or a map is judged by; None and False claim nothing.

    `order`: of convergence, at least. `area_order`: ΔJ = O(h^area_order). `area_preserving`:
    det J ≡ 1. `symplectic`: JᵀΩJ ≡ Ω, the same in the plane, and more in several degrees of
    freedom.
    """

    order: int | None = None
    area_order: int | None = None
    area_preserving: bool = False
    symplectic: bool = False


NO_CLAIMS = Claims()


@dataclass(frozen=True)
class Counterexample:
    """A place at which a claim is seen to fail.

    `z`: the state, by the names of the coordinates; `h`: the step size, None of a map; `t`: the
    time, None where H does not depend on it. `found`: the value of `quantity` there, as text;
    `expected`: the value that it would have to have.
    """

    z: dict[str, Fraction]
    h: Fraction | None
    quantity: str
    found: str
    expected: str
    t: Fraction | None = None

    @property
    def place(self) -> str:
        """The place, as text."""
        parts = [f"{name} = {x}" for name, x in self.z.items()]
        parts += [f"t = {self.t}"] if self.t is not None else []
        parts += [f"h = {self.h}"] if self.h is not None else []
        return ", ".join(parts)

    def __str__(self) -> str:
        return f"at {self.place}: {self.quantity} is {self.found}, expected {self.expected}"


@dataclass(frozen=True)
class KeptStructure:
    """The verdict on one structure, None if it is not kept and nothing is claimed of it.

    `claimed`: the order of its defect, None if it has to vanish.
    `how`: "proof", "duals", "floats" or "calls". `exact`: True if the defect is 0, or 0 up to the
    noise; None if that is open. `order`: the first power of h in the defect, None where it is 0 or
    not known. `leading`, `telescopes`, `potential`, `domain`: of a proof. `largest`: the largest
    measured defect, in natural units, and `probe_error` its noise. `way_back`: what is lost on the
    way back in the code's own numbers.
    """

    structure: Structure
    verdict: Verdict | None
    reason: Prose
    how: str
    claimed: int | None = None
    exact: bool | None = None
    order: int | None = None
    leading: str = ""
    component: str = ""
    telescopes: bool | None = None
    potential: str | None = None
    domain: FormulaDomain = EVERYWHERE
    largest: float | None = None
    probe_error: float | None = None
    counterexample: Counterexample | None = None
    way_back: WayBack | None = None


@dataclass(frozen=True)
class Finding:
    """The finding on a user's step or map: `verdict` with its `reason`, one sentence.

    `how`: "proof", "duals", "floats", or "calls" where the function was only called. `degrees`: of
    freedom. `domain`: where the verdict holds, one condition a text. `notes`: sentences beside it;
    `faults`: their names; `counterexample`: of a claim that fails.

    Of the structure: `symplectic` and `area_preserving`, None where they are open. `order`: the
    defect, ΔJ or S, is O(h^order) and no better, None where it is 0 or not known; `area_at_least`:
    then it may be known to be O(h^area_at_least). `largest`: the largest defect that was measured,
    in units of its place, and `probe_error`: the error of such a value; `against`: the reading that
    has it, and `entry` the name of its entry of S.

    Of the map: `convergence_order`, None where no difference from the exact flow is seen, or, with
    `order_decided` False, where it is not known.

    `keeps`: the verdicts on structures, those that are claimed if any are.

    Of a proof: `proof` itself, and the formulas `leading`, the leading coefficient of the defect,
    and `delta_j`. Of a measurement: `places`, where was looked.
    """

    verdict: Verdict
    reason: Prose
    how: str
    degrees: int = 1
    order: int | None = None
    symplectic: bool | None = None
    area_preserving: bool | None = None
    area_at_least: int | None = None
    convergence_order: int | None = None
    order_decided: bool = False
    leading: str | None = None
    delta_j: str | None = None
    proof: Proof | None = field(default=None, repr=False)
    largest: float | None = None
    probe_error: float | None = None
    against: DefectReading | None = field(default=None, repr=False)
    entry: str = ""
    domain: tuple[str, ...] = ()
    notes: tuple[Prose, ...] = ()
    faults: tuple[str, ...] = ()
    counterexample: Counterexample | None = None
    places: tuple[TrialPlace, ...] = field(default=(), repr=False)
    keeps: tuple[KeptStructure, ...] = field(default=(), repr=False)

    def __repr__(self) -> str:
        return f"Finding({self.verdict}: {self.reason})"

    @property
    def scheme(self) -> bool:
        """True if it is shown to agree with the exact flow up to h, at least."""
        if self.convergence_order is None:
            return self.order_decided
        return self.convergence_order >= 1 and (self.order_decided or self.how == "proof")

    def noting(self, *notes: str) -> "Finding":
        """Return the same finding with further notes."""
        return replace(self, notes=(*self.notes, *map(prose, notes)))


class JudgedClaim(NamedTuple):
    """A claim, in words; `holds`: None where it is not decided; `evidence`: what is known."""

    name: Prose
    holds: bool | None
    evidence: Prose


def describe_agreement(power: int | None) -> str:
    """Describe how far the map and the flow agree, where a higher order is claimed."""
    if power is not None and power < 0:
        return "the map's distance from the exact flow does not vanish as h → 0"
    return f"the map agrees with the exact flow up to `h^{power}` only"


def judge_claims(claims: Claims, finding: Finding) -> list[JudgedClaim]:
    """Judge each claim that is made, by what was proved or measured."""
    rows: list[tuple[str, bool | None, str]] = []
    if claims.order is not None:
        holds = None
        if finding.order_decided:
            holds = finding.convergence_order is None or finding.convergence_order >= claims.order
        rows.append((f"order {claims.order}", holds, describe_agreement(finding.convergence_order)))
    defect = _describe_defect(finding)
    if claims.symplectic and finding.degrees > 1:
        rows.append(("that it is symplectic", finding.symplectic, defect))
    elif claims.symplectic or claims.area_preserving:
        rows.append(("det J ≡ 1", finding.area_preserving, defect))
    if claims.area_preserving and finding.degrees > 1:
        rows.append(("det J ≡ 1", finding.area_preserving, _describe_volume(finding)))
    if claims.area_order is not None:
        rows.append(_area_order(claims.area_order, finding, defect))
    return [
        JudgedClaim(read_prose(name), holds, read_prose(evidence)) for name, holds, evidence in rows
    ]


def _describe_defect(finding: Finding) -> str:
    name = structure_in(finding.degrees).symbol
    if finding.order is not None:
        return f"{name} has order {finding.order}"
    if finding.area_at_least is not None:
        return (
            f"{name} is not 0, but O(`h^{finding.area_at_least}`), as where an iteration ends early"
        )
    return f"{name} is not 0"


def _volume_power(finding: Finding) -> int | None:
    if finding.degrees == 1:
        return finding.order
    return finding.proof.volume_order if finding.proof else None


def _describe_volume(finding: Finding) -> str:
    power = _volume_power(finding)
    return f"det J − 1 has order {power}" if power else "det J is not 1"


def _area_order(claimed: int, finding: Finding, defect: str) -> tuple[str, bool | None, str]:
    is_bounded = finding.area_at_least is not None and claimed <= finding.area_at_least
    # A defect that vanishes is O(h^r) for every r; a lower bound of its power shows no more than
    # that power.
    holds = True if finding.area_preserving or is_bounded else None
    power = _volume_power(finding)
    if power is not None:
        holds = power >= claimed
    return (
        f"ΔJ = O(`h^{claimed}`)",
        holds,
        defect if finding.degrees == 1 else _describe_volume(finding),
    )


def potential_of_finding(finding: Finding) -> Potential:
    """Return the decision if the leading coefficient of ΔJ telescopes, as far as it is proved; in
    the plane."""
    if finding.proof is not None:
        return potential_of(finding.proof)
    if finding.area_preserving and finding.how == "proof":
        return Potential(True, "ΔJ ≡ 0")
    return Potential(None, "the leading coefficient is not proved")
