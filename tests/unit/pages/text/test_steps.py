"""Proofs as steps: a sentence each, nothing lost, nothing cut within an abbreviation."""

import re

from markupsafe import Markup

from verify.pages.text.steps import steps
from verify.prose import Formula, prose, read_prose

LONG = read_prose(
    "Write w = ∇H. By Eq. 9 it holds (see Fig. 2, cf. Eqs. 3 and 4), i.e. everywhere. Then "
    "`|p̃_{k+1} - p_{k+1}| <= (1 + hL) |p̄_k - p_k|` at 0.5. So it is <b>zero</b>. ∎"
)


def items(markup: Markup) -> list[str]:
    return re.findall(r"<li>(.*?)</li>", markup, re.DOTALL)


def test_each_sentence_is_a_step_and_an_abbreviation_ends_none() -> None:
    found = items(steps(LONG))
    assert len(found) == 4
    assert found[0] == "Write w = ∇H."
    assert found[1].startswith("By Eq. 9 it holds (see Fig. 2, cf. Eqs. 3 and 4), i.e. everywhere.")
    assert found[3] == "So it is &lt;b&gt;zero&lt;/b&gt;. ∎", "its end is no step of its own"


def test_a_long_formula_has_a_line_of_its_own_and_a_short_one_has_not() -> None:
    assert items(steps(LONG))[2].startswith('Then <span class="displayed">|p̃')
    short = prose("A. B. C. Then ", Formula("h^3"), ". D.")
    assert "displayed" not in steps(short)


def test_nothing_of_the_text_is_lost() -> None:
    plain = re.sub("<[^>]*>", "", " ".join(items(steps(LONG))))
    words = re.findall(r"[A-Za-z]{3,}", str(LONG))
    assert [w for w in words if w not in plain] == []


def test_a_short_proof_stays_a_paragraph() -> None:
    assert steps("It is so. ∎") == "<p>It is so. ∎</p>"
