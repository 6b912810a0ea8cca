"""Who checked a proof, beside it: by a word, below it by name, and step by step on paper."""

import re
from typing import Any

from tests.unit.pages.test_page import EVIL, proof, report, scene
from verify.pages.page import render
from verify.prose import prose, read_prose
from verify.scenes.results.claim import ClaimResult, StepResult
from verify.verdict import Verdict


def argued(**changes: Any) -> ClaimResult:
    steps = (
        StepResult(
            text=read_prose(f"By `L_{{H_p}}` ``x ≤ y`` and {EVIL}."),
            checked_by=(prose("exact algebra, rows 1–2"), prose("Rocq, Sums.size_of_sum")),
            tried=(prose("exact numbers, row 3"),),
        ),
        StepResult(text=prose(f"So it is. {EVIL}")),
    )
    own = {
        "id": "a", "kind": "theorem", "source": "Eq. 3", "statement": "s", "scene": "",
        "verdict": Verdict.PROVED, "evidence": "e", "proof": prose("all of it ∎"),
        "given": prose(f"Let x be. {EVIL}"), "steps": steps, "remark": prose(f"Thus. {EVIL}"),
        "checked_by": (prose(f"small checker: det J = 1 {EVIL}"), prose("Rocq, A.b: so it is")),
        "details": tuple((prose(a), prose("0")) for a in ("what", "one", "two", "three")),
    }  # fmt: skip
    return ClaimResult(**{**own, **changes})


def test_an_argument_on_paper_stands_with_its_claim_step_by_step_and_is_escaped() -> None:
    page = render(report(claims=(argued(),)))
    first, second = re.findall(r"<li>(By .*?|So .*?)</li>", page)
    assert "By L<sub>H<sub>p</sub></sub> <math" in first
    marks = [re.sub("<[^>]*>", "", x) for x in re.findall(r'<i class="by.*?</i>', first + second)]
    assert marks == [
        "✓ exact algebra, rows 1–2; Rocq, Sums.size_of_sum; tried: exact numbers, row 3",
        "not checked by machine",
    ]
    assert [re.sub(r"\s", "", x) for x in re.findall(r'<td class="n">(.*?)</td>', page)] == [
        "1", "2", "3",
    ]  # fmt: skip
    assert EVIL not in page


def test_who_checked_a_claim_stands_with_it_and_in_a_word_beside_its_verdict() -> None:
    page = render(report(claims=(argued(),)))
    assert '<span class="who">small checker, Rocq</span>' in page
    assert "<b>small checker</b>: det J = 1" in page
    assert "<b>Rocq</b>, A.b: so it is" in page
    nobody = render(report(claims=(argued(checked_by=()),)))
    assert 'class="who"' not in nobody
    assert 'class="checked"' not in nobody


def test_a_proof_without_steps_is_a_paragraph_and_none_is_nothing() -> None:
    page = render(report(claims=(argued(steps=()),)))
    assert "<p>all of it ∎</p>" in page
    assert "on paper" not in render(report(claims=(argued(steps=(), proof=""),)))


def test_who_checked_a_scenes_proof_stands_below_it() -> None:
    by = (prose(f"small checker: det J − 1 = L {EVIL}"),)
    page = render(report((scene(proofs=(proof(checked_by=by),)),)))
    assert "<b>small checker</b>: det J − 1 = L" in page
    assert EVIL not in page
    assert 'class="checked"' not in render(report((scene(proofs=(proof(),)),)))
