"""Claims that may be made for every H, or for every H = T(p) + V(q); then they have no scene.

H may depend on time in either case.

A claim for every H with ΔJ = c h^r + … says that c is an expression in the derivatives of H that
does not vanish for some H; det J ≡ 1 is false if det J differs from 1 for some H.
"""

from abc import abstractmethod
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from verify.claims.base_claim import Claim, Findings
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes import get

if TYPE_CHECKING:
    from verify.proof.checked.proved_statement import About
    from verify.proof.proof_for_every_h import ProofForEveryH

    AboutAll = frozenset[About]

# The part of a proof on which a claim relies, so that only the marks of that part are shown.
OF_DELTA_J: "AboutAll" = frozenset({"volume"})
OF_S: "AboutAll" = frozenset({"defect"})
OF_MAP: "AboutAll" = frozenset({"map"})
OF_LAMBDA: "AboutAll" = frozenset({"product"})
EVERY_SEPARABLE = "separable hamiltonian"
_IN_TIME = " in time"
Every = Literal[
    "hamiltonian", "separable hamiltonian", "hamiltonian in time", "separable hamiltonian in time"
]


class FamilyClaim(Claim):
    """The base of the kinds that have `every`."""

    every: Every | None = None
    """The family of H for which it is claimed, in place of one H; `in time`: H may depend on t."""

    def judge(self, findings: Findings) -> ClaimResult:
        """Judge for every H of the claim, or for the scene's H."""
        return self.judge_one(findings) if self.every is None else self.judge_family()

    @property
    def of_separable(self) -> bool:
        """True if it is a claim for every H = T + V."""
        return self.every is not None and self.every.startswith(EVERY_SEPARABLE)

    @property
    def in_time(self) -> bool:
        """True if it is a claim for every H that depends on time."""
        return self.every is not None and self.every.endswith(_IN_TIME)

    @abstractmethod
    def judge_one(self, findings: Findings) -> ClaimResult:
        """Return the verdict for the scene's H."""

    @abstractmethod
    def judge_family(self) -> ClaimResult:
        """Return the verdict for every H of the family."""

    def check_every(self) -> None:
        """Raise InputError if the scheme does not admit a claim for every such H."""
        every_h = get(self.scheme).every_h
        if every_h is None:
            raise InputError("scheme", self.scheme, "is given for one H, not for every H")
        quantifier = EVERY_SEPARABLE + _IN_TIME * self.in_time
        if every_h.separable and not self.of_separable:
            problem = f"{self.scheme} takes H = T(p) + V(q) only; say {quantifier!r}"
            raise InputError("every", self.every, problem)
        if self.in_time and self.of_separable and not every_h.separable:
            problem = f"{self.scheme} takes more than that; say 'hamiltonian in time'"
            raise InputError("every", self.every, problem)


class QuantifiedClaim(FamilyClaim):
    """The base of the kinds with `every` that are judged by the orders of ΔJ and of the map.

    `about`: the parts of a proof on which it relies; see `verify.proof.checked.proved_statement`.
    """

    about: ClassVar["AboutAll"] = frozenset()

    @property
    def least_order(self) -> int:
        """The least order of the map up to which a proof must examine it."""
        return 0

    def judge_family(self) -> ClaimResult:
        """Judge by the proof for every H of the claim."""
        from verify.proof.order_for_every_h import prove_for_every_h

        return self.judge_every(prove_for_every_h(self.scheme, **self._proof_options))

    def checked_by(self, result: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """Return the marks of the proof for every H of the claim, or for the scene's H."""
        if self.every is None:
            return marks_for_scene(self, findings, self.about)
        return marks_for_every(self.scheme, self.about, **self._proof_options)

    @property
    def _proof_options(self) -> dict[str, Any]:
        """The arguments of `prove_for_every_h` for the proof that it needs."""
        return {"separable": self.of_separable, "timed": self.in_time, "least": self.least_order}

    @abstractmethod
    def judge_every(self, proof: "ProofForEveryH") -> ClaimResult:
        """Return the verdict for every H, by the proof for all of them."""

    def why_not_transferable(self) -> str:
        return "" if self.every else self.obstacle

    def for_hamiltonian(self, hamiltonian: Hamiltonian) -> Self:
        return self.model_copy(update={"every": None})


# -- who checked the proof that decides a claim ----------------------------------------------------


def marks_for_scene(claim: Claim, findings: Findings, about: "AboutAll") -> tuple[Prose, ...]:
    """Return the marks of the proof for the H of the claim's scene."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    return marks_for_hamiltonian(hamiltonian, claim.scheme, about)


@lru_cache(maxsize=64)
def marks_for_hamiltonian(
    hamiltonian: Hamiltonian, name: str, about: "AboutAll"
) -> tuple[Prose, ...]:
    """Return the marks of the proof for this H."""
    from verify.claims.formula_claims import proof_of
    from verify.proof.checked.proof_marks import marks
    from verify.proof.checked.proved_statement import statement_for_one_h

    proof = proof_of(hamiltonian, name)
    return marks(statement_for_one_h(proof, hamiltonian, get(name), about))


@lru_cache(maxsize=64)
def marks_for_every(
    name: str, about: "AboutAll", *, separable: bool, timed: bool, least: int
) -> tuple[Prose, ...]:
    """Return the marks of the proof for every H of this family; `least`: as `prove_for_every_h`."""
    from verify.proof.checked.proof_marks import marks
    from verify.proof.checked.proved_statement import statement_for_every_h
    from verify.proof.order_for_every_h import prove_for_every_h

    proof = prove_for_every_h(name, separable=separable, timed=timed, least=least)
    return marks(statement_for_every_h(proof, get(name), about))
