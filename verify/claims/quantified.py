"""A claim that may be made of every H, or of every H = T(p) + V(q); then it has no scene.

Either may depend on time.

"For every H" means: whatever H is. ΔJ = c h^r + … then has a c made of derivatives of H, and c is
not zero for some H; det J ≡ 1 is false where some H has another det J.
"""

from abc import abstractmethod
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from verify.claims.claim import Claim
from verify.claims.findings import Findings
from verify.errors import InputError
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.prose import Prose
from verify.scenes.results.claim import ClaimResult
from verify.schemes import get

if TYPE_CHECKING:
    from verify.proof.checked.proved import About
    from verify.proof.every_proof import EveryProof

    AboutAll = frozenset[About]

# What of a proof a claim asks about.
OF_DELTA_J: "AboutAll" = frozenset({"volume"})
OF_S: "AboutAll" = frozenset({"defect"})
OF_MAP: "AboutAll" = frozenset({"map"})
OF_LAMBDA: "AboutAll" = frozenset({"product"})
EVERY_SEPARABLE = "separable hamiltonian"
_IN_TIME = " in time"
Every = Literal[
    "hamiltonian", "separable hamiltonian", "hamiltonian in time", "separable hamiltonian in time"
]


class QuantifiedClaim(Claim):
    """The base of the kinds that have `every`. `about`: what of a proof it asks about; see
    `verify.proof.checked.proved`."""

    about: ClassVar["AboutAll"] = frozenset()

    every: Every | None = None
    """Of which H, all of them, in place of one; `in time`: of all that depend on t, too."""

    @property
    def looked_at(self) -> int:
        """The order of the map that a proof is to look at, at least."""
        return 0

    def judge(self, findings: Findings) -> ClaimResult:
        """By the proof for every H that it is made of, or for the scene's."""
        if self.every is None:
            return self.judge_one(findings)
        from verify.proof.every import prove_every

        return self.judge_every(prove_every(self.scheme, **self._of_which))

    def checked_by(self, found: ClaimResult, findings: Findings) -> Sequence[Prose]:
        """By the proof for every H that it is made of, or for the scene's."""
        if self.every is None:
            return marks_for_scene(self, findings, self.about)
        return marks_for_every(self.scheme, self.about, **self._of_which)

    @property
    def _of_which(self) -> dict[str, Any]:
        """Which proof for every H it asks for."""
        return {"separable": self.of_separable, "timed": self.in_time, "least": self.looked_at}

    @property
    def of_separable(self) -> bool:
        """Whether it is made of every H = T + V."""
        return self.every is not None and self.every.startswith(EVERY_SEPARABLE)

    @property
    def in_time(self) -> bool:
        """Whether it is made of every H that depends on time."""
        return self.every is not None and self.every.endswith(_IN_TIME)

    @abstractmethod
    def judge_one(self, findings: Findings) -> ClaimResult:
        """The verdict for the scene's H."""

    @abstractmethod
    def judge_every(self, proof: "EveryProof") -> ClaimResult:
        """The verdict for every H, by what is proved for all of them."""

    def check_every(self) -> None:
        """Raises InputError where the claim cannot be made of every H that it says."""
        every_h = get(self.scheme).every_h
        if every_h is None:
            raise InputError("scheme", self.scheme, "is given for one H, not for every H")
        own = EVERY_SEPARABLE + _IN_TIME * self.in_time
        if every_h.separable and not self.of_separable:
            problem = f"{self.scheme} takes H = T(p) + V(q) only; say {own!r}"
            raise InputError("every", self.every, problem)
        if self.in_time and self.of_separable and not every_h.separable:
            problem = f"{self.scheme} takes more than that; say 'hamiltonian in time'"
            raise InputError("every", self.every, problem)

    def why_only_here(self) -> str:
        return "" if self.every else self.only_here

    def of_one(self, hamiltonian: Hamiltonian) -> Self:
        return self.model_copy(update={"every": None})


# -- who checked the proof that decides a claim ----------------------------------------------------


def marks_for_scene(claim: Claim, findings: Findings, about: "AboutAll") -> tuple[Prose, ...]:
    """The marks of the proof for the H of the claim's scene."""
    hamiltonian = findings.scene_of(claim).exact_hamiltonian()
    return marks_for_hamiltonian(hamiltonian, claim.scheme, about)


@lru_cache(maxsize=64)
def marks_for_hamiltonian(
    hamiltonian: Hamiltonian, name: str, about: "AboutAll"
) -> tuple[Prose, ...]:
    """The marks of the proof for this H."""
    from verify.claims.formulas import proof_of
    from verify.proof.checked import marks
    from verify.proof.checked.proved import of_one_hamiltonian

    proof = proof_of(hamiltonian, name)
    return marks(of_one_hamiltonian(proof, hamiltonian, get(name), about))


@lru_cache(maxsize=64)
def marks_for_every(
    name: str, about: "AboutAll", *, separable: bool, timed: bool, least: int
) -> tuple[Prose, ...]:
    """The marks of the proof for every H that is meant; `least` as for `prove_every`."""
    from verify.proof.checked import marks
    from verify.proof.checked.proved import of_every_hamiltonian
    from verify.proof.every import prove_every

    proof = prove_every(name, separable=separable, timed=timed, least=least)
    return marks(of_every_hamiltonian(proof, get(name), about))
