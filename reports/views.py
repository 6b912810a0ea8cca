"""Report → what the page's templates show: anchors, groups, sentences. Nothing is computed anew."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from reports import plots
from reports.claim_view import Anchors, ClaimView, Contrast, contrasts
from reports.plots import Plot
from reports.scene_view import SceneView, scene_view
from reports.typography import listed, superscript
from verify.results import ProofResult
from verify.scene_results import Report
from verify.verdict import Verdict


@dataclass(frozen=True)
class Highlight:
    """The most telling refutation."""

    claim: ClaimView
    plot: Plot | None
    contrasts: tuple[Contrast, ...]
    same_row: tuple[ClaimView, ...]  # other refuted tables that print the very same row


@dataclass(frozen=True)
class PageView:
    report: Report
    finding: str
    counts: tuple[tuple[Verdict, int], ...]
    claims: tuple[ClaimView, ...]
    refuted: tuple[ClaimView, ...]
    highlight: Highlight | None
    scenes: tuple[SceneView, ...]
    ran: bool  # whether anything was run
    separated: bool
    grown: bool  # whether Λ was held against its growth law
    timed: bool  # whether error stands against run time


def page_view(report: Report) -> PageView:
    anchors = Anchors()
    own = [anchors.take("system", scene.name) for scene in report.scenes]
    scene_anchors = {s.name: anchor for s, anchor in zip(report.scenes, own, strict=True)}
    titles = {s.name: s.title for s in report.scenes}
    claims = tuple(
        ClaimView(
            c, anchors.take("claim", c.id), scene_anchors.get(c.scene, ""), titles.get(c.scene, "")
        )
        for c in report.claims
    )
    refuted = tuple(c for c in claims if c.result.verdict is Verdict.REFUTED)
    counted = Counter(c.verdict for c in report.claims)
    return PageView(
        report=report,
        ran=any(
            s.runs or s.series or s.separations or s.crossovers or s.work_precision
            for s in report.scenes
        ),
        separated=any(s.separations or s.crossovers for s in report.scenes),
        grown=any(s.growth_laws for s in report.scenes),
        timed=any(s.work_precision for s in report.scenes),
        finding=finding(report),
        counts=tuple((v, counted[v]) for v in Verdict if counted[v]),
        claims=claims,
        refuted=refuted,
        highlight=_highlight(refuted),
        scenes=tuple(
            scene_view(
                scene, anchor, [c for c in claims if c.result.scene == scene.name and c.is_table]
            )
            for scene, anchor in zip(report.scenes, own, strict=True)
        ),
    )


# -- the finding in one sentence ------------------------------------------------------------------


def finding(report: Report) -> str:
    if report.claims:
        return _finding_of_claims([c.verdict for c in report.claims])
    proofs = [proof for scene in report.scenes for proof in scene.proofs]
    if not proofs:
        return "The report holds no claim and no proof."
    if len(proofs) <= 4:
        return "; ".join(_finding_of_proof(p) for p in proofs) + "."
    preserving = sum(p.area_preserving is True for p in proofs)
    ordered = sum(p.order is not None for p in proofs)
    parts = [(preserving, "with det J ≡ 1"), (ordered, "with a ΔJ of a proved order in h")]
    parts.append((len(proofs) - preserving - ordered, "undecided"))
    shown = listed(f"{n} {text}" for n, text in parts if n)
    return f"{len(proofs)} step maps were examined: {shown}."


def _finding_of_claims(verdicts: Sequence[Verdict]) -> str:
    counted = Counter(verdicts)
    words = [(counted[v], v.lower()) for v in Verdict if counted[v]]
    if len(words) == 1:
        count, word = words[0]
        return f"The one claim is {word}." if count == 1 else f"All {count} claims are {word}."
    (count, word), *rest = words
    first = f"{count} {'is' if count == 1 else 'are'} {word}"
    return f"Of {len(verdicts)} claims, {listed([first, *(f'{n} {w}' for n, w in rest)])}."


def _finding_of_proof(proof: ProofResult) -> str:
    if proof.area_preserving:
        return f"{proof.scheme} preserves area exactly (det J ≡ 1)"
    if proof.order is not None:
        return f"ΔJ of {proof.scheme} is of order h{superscript(proof.order)}"
    return f"the order of ΔJ of {proof.scheme} is undecided"


# -- the most telling refutation ------------------------------------------------------------------


def _highlight(refuted: Sequence[ClaimView]) -> Highlight | None:
    """A refuted table if there is one, since it sets numbers against numbers; else the first."""
    if not refuted:
        return None
    tables = [c for c in refuted if c.is_table]
    claim = next(iter(tables), refuted[0])
    same = tuple(c for c in tables if c is not claim and c.printed == claim.printed)
    if not claim.is_table:
        return Highlight(claim, None, (), ())
    return Highlight(claim, plots.table(claim, name="highlight"), tuple(contrasts(claim)), same)
