"""A claims file → verdicts: plans what the chosen claims need, executes it, judges."""

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from verify.check_claims import check_claim
from verify.claim_plan import add_claims
from verify.claims import Claim
from verify.claims_file import ClaimsFile
from verify.errors import InputError
from verify.execute import Done, Result, Store, execute
from verify.findings import Findings
from verify.plan import Plan
from verify.results import ClaimResult


@dataclass(frozen=True)
class Check:
    """The claims of a file that are to be checked, and the plan of what they need."""

    file: ClaimsFile
    claims: tuple[Claim, ...]
    plan: Plan
    known: dict[str, Result]

    def run(
        self, store: Store, *, workers: int | None = None, done: Done | None = None
    ) -> list[ClaimResult]:
        """Each claim's verdict, in their order. InputError names the claim and its line."""
        results = execute(self.plan, store, workers=workers, done=done)
        findings = Findings(self.file.scenes, {**self.known, **results})
        found = []
        for claim in self.claims:
            try:
                found.append(check_claim(claim, findings))
            except InputError as error:
                index = self.file.claims.index(claim)
                raise self.file.located(index, claim.id, error) from None
        return found


def prepare(file: ClaimsFile, only: Sequence[str] = ()) -> Check:
    """All claims of the file, or those whose ids `only` names; `eq-*` names several.

    Raises InputError for a name that no claim has.
    """
    for wanted in only:
        if not any(_named(claim, wanted) for claim in file.claims):
            names = ", ".join(claim.id for claim in file.claims)
            raise InputError("--only", wanted, f"no claim has this id; there are: {names}")
    chosen = [c for c in file.claims if not only or any(_named(c, name) for name in only)]
    plan = Plan()
    known = add_claims(plan, chosen, file.scenes)
    return Check(file, tuple(chosen), plan, known)


def _named(claim: Claim, wanted: str) -> bool:
    return claim.id == wanted or fnmatchcase(claim.id, wanted)
