"""What the paper leaves open, and the verdicts that depend on the choice."""

from collections.abc import Sequence
from dataclasses import dataclass

from verify.pages.sections.page_contents import ClaimView, PageContents
from verify.pages.sections.section import ReportSection
from verify.scenes.paper_sections import Assumption
from verify.verdict import Verdict


@dataclass(frozen=True)
class AssumptionView:
    """An assumption; `pairs`: a claim that rests on it, the same claim otherwise, and a word that
    says if the verdict flips; `settled_by`: claims that show that nothing depends on it."""

    assumption: Assumption
    pairs: tuple[tuple[ClaimView, ClaimView, str], ...]
    settled_by: tuple[ClaimView, ...]


def _flip(verdict: Verdict, otherwise: Verdict) -> str:
    """Return if a verdict flips: “yes”, “no”, or “not decided” where one of the two is not."""
    if Verdict.UNDECIDED in (verdict, otherwise):
        return "not decided"
    return "yes" if verdict.holds is not otherwise.holds else "no"


def _views(contents: PageContents) -> Sequence[AssumptionView]:
    claims = {claim.result.id: claim for claim in contents.claims}
    return [
        AssumptionView(
            assumption,
            tuple(
                (one, other, _flip(one.result.verdict, other.result.verdict))
                for pair in assumption.decides
                for one, other in [(claims[pair.claim], claims[pair.otherwise])]
            ),
            tuple(claims[name] for name in assumption.settled_by),
        )
        for assumption in contents.report.assumptions
    ]


SECTION = ReportSection(order=4, title="What is assumed", anchor="assumed", view=_views)
