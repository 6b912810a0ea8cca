"""What was found of a user's step, and what it claims."""

from dataclasses import dataclass, field, replace
from fractions import Fraction

from verify.proof.order_proof import Proof
from verify.proof.potential import Potential, potential_of
from verify.prose import Prose, prose, read_prose
from verify.schemes.scheme import Scheme
from verify.verdict import Verdict

MOST_CLAIMED = 12


@dataclass(frozen=True)
class Claims:
    """What is asked for; None and False ask for nothing.

    `order`: of convergence, at least. `area_order`: ΔJ = O(h^area_order). `area_preserving`:
    det J ≡ 1. `symplectic`: the same in the plane, and more in several degrees of freedom.
    """

    order: int | None = None
    area_order: int | None = None
    area_preserving: bool = False
    symplectic: bool = False


NOTHING = Claims()


@dataclass(frozen=True)
class Counterexample:
    """At (p, q) with step h: what `quantity` is there, and what it would have to be.

    `t`: where H depends on it.
    """

    p: Fraction
    q: Fraction
    h: Fraction
    quantity: str
    found: str
    expected: str
    t: Fraction | None = None

    def __str__(self) -> str:
        time = "" if self.t is None else f", t = {self.t}"
        at = f"at p = {self.p}, q = {self.q}{time}, h = {self.h}"
        return f"{at}: {self.quantity} is {self.found}, expected {self.expected}"


@dataclass(frozen=True)
class Finding:
    """`verdict` with its `reason`; `how`: "proof", "duals", "floats", or "calls" where the function
    was only called.

    `domain`: where the verdict holds, one condition a text.
    `order`: ΔJ = O(h^order) and no better, None where det J ≡ 1 or it is not known.
    `area_at_least`: then ΔJ = O(h^area_at_least) may be known. `convergence_order`: None where no
    difference from the exact flow is found, or, with `order_decided` False, where it is not known.
    `leading`, `delta_j`: formulas, of a proof. `largest`: the largest |ΔJ| that was measured, and
    `probe_error`: the error of such a value.
    """

    verdict: Verdict
    reason: Prose
    how: str
    order: int | None = None
    area_preserving: bool | None = None
    area_at_least: int | None = None
    convergence_order: int | None = None
    order_decided: bool = False
    leading: str | None = None
    delta_j: str | None = None
    proof: Proof | None = field(default=None, repr=False)
    largest: float | None = None
    probe_error: float | None = None
    domain: tuple[str, ...] = ()
    notes: tuple[Prose, ...] = ()
    faults: tuple[str, ...] = ()
    counterexample: Counterexample | None = None

    def __repr__(self) -> str:
        return f"Finding({self.verdict}: {self.reason})"

    @property
    def scheme(self) -> bool:
        """Whether it is shown to agree with the exact flow up to h, at least."""
        if self.convergence_order is None:
            return self.order_decided
        return self.convergence_order >= 1 and (self.order_decided or self.how == "proof")

    def noting(self, *notes: str) -> "Finding":
        """The same with further notes."""
        return replace(self, notes=(*self.notes, *map(prose, notes)))


Judged = tuple[Prose, bool | None, Prose]  # a claim, whether it holds, and what was found


def agreement_told(power: int | None) -> str:
    """How far the map and the flow agree, where a higher order is claimed."""
    if power is not None and power < 0:
        return "the map's distance from the exact flow does not vanish as h → 0"
    return f"the map agrees with the exact flow up to `h^{power}` only"


def judged(claims: Claims, found: Finding) -> list[Judged]:
    """Each claim; None where it is not decided."""
    told: list[tuple[str, bool | None, str]] = []
    if claims.order is not None:
        holds = None
        if found.order_decided:
            holds = found.convergence_order is None or found.convergence_order >= claims.order
        known = agreement_told(found.convergence_order)
        told.append((f"order {claims.order}", holds, known))
    area = f"ΔJ has order {found.order}"
    if found.order is None:
        area = "ΔJ is not 0"
        if found.area_at_least is not None:
            area = (
                f"ΔJ is not 0, but O(`h^{found.area_at_least}`), as where an iteration ends early"
            )
    if claims.area_preserving or claims.symplectic:
        told.append(("det J ≡ 1", found.area_preserving, area))
    if claims.area_order is not None:
        shown = found.area_at_least is not None and claims.area_order <= found.area_at_least
        holds = True if found.area_preserving or shown else None
        if found.order is not None:
            holds = found.order >= claims.area_order
        told.append((f"ΔJ = O(`h^{claims.area_order}`)", holds, area))
    return [(read_prose(claim), holds, read_prose(known)) for claim, holds, known in told]


def potential_of_finding(found: Finding) -> Potential:
    """As of a scheme that is known by its proof alone."""
    proof = found.proof
    if proof is None:
        if found.area_preserving and found.how == "proof":
            return Potential(True, "ΔJ ≡ 0")
        return Potential(None, "the leading coefficient is not proved")
    alone = Scheme(
        name="step",
        order=1,
        area_preserving=False,
        explicit=False,
        symmetric=False,
        source="the user's function",
        build=lambda _: proof.step_map,
    )
    return potential_of(proof, alone)
