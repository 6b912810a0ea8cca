"""A claims file → verdicts: plans what the chosen claims need, executes it, judges."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import compress
from operator import not_

from verify.claims.claim import Claim
from verify.claims.file import ClaimsFile
from verify.claims.judging import add_claims, judged
from verify.errors import InputError, is_meant, nearest
from verify.execution.execute import OnResult, Store, execute
from verify.execution.executors import ANYWHERE, Placement
from verify.execution.plan import Plan
from verify.scenes.frozen import Frozen
from verify.scenes.results.claim import ClaimResult
from verify.scenes.results.statement import StatementResult, statements_of


@dataclass(frozen=True)
class Check:
    """The claims of a file that are to be checked, and the plan of what they need."""

    file: ClaimsFile
    claims: tuple[Claim, ...]
    plan: Plan
    known: dict[str, Frozen]

    def run(
        self, store: Store, *, where: Placement = ANYWHERE, done: OnResult | None = None
    ) -> list[ClaimResult]:
        """Each claim's verdict, in their order. InputError names the claim and its line.

        What algebra decides comes first: a formula that turns out to be none costs no run.
        """
        found: dict[str, ClaimResult] = {}
        exact = [claim.exact for claim in self.claims]
        for claim in compress(self.claims, exact):
            found[claim.id] = self._judge(claim, {}, store, where)
        results = execute(self.plan, store, where=where, done=done)
        for claim in compress(self.claims, map(not_, exact)):
            found[claim.id] = self._judge(claim, {**self.known, **results}, store, where)
        return [found[claim.id] for claim in self.claims]

    def statements(self, found: Sequence[ClaimResult]) -> tuple[StatementResult, ...]:
        """The statements all of whose readings are among the claims that are checked."""
        chosen = {claim.id for claim in self.claims}
        missing = {claim.reading_of for claim in self.file.claims if claim.id not in chosen}
        return tuple(each for each in statements_of(found) if each.id not in missing)

    def _judge(
        self, claim: Claim, results: Mapping[str, Frozen], store: Store, where: Placement
    ) -> ClaimResult:
        try:
            return judged(claim, self.file.scenes, results, store, where)
        except InputError as error:
            index = self.file.claims.index(claim)
            raise self.file.located(index, claim.id, error) from None


def prepare(file: ClaimsFile, only: Sequence[str] = ()) -> Check:
    """All claims of the file, or those whose ids `only` names; `eq-*` names several.

    Raises InputError for a name that no claim has.
    """
    for wanted in only:
        if not any(_named(claim, wanted) for claim in file.claims):
            names = [claim.id for claim in file.claims]
            meant = is_meant(nearest(wanted.lower(), names))
            problem = f"no claim has this id; {meant}there are: {', '.join(names)}"
            raise InputError("--only", wanted, problem)
    chosen = [c for c in file.claims if not only or any(_named(c, name) for name in only)]
    plan = Plan()
    known = add_claims(plan, chosen, file.scenes)
    return Check(file, tuple(chosen), plan, known)


def _named(claim: Claim, wanted: str) -> bool:
    return claim.id == wanted or fnmatchcase(claim.id, wanted)
