"""What a notebook shows of a result: its numbers with their bounds, and text that stays text."""

import re
from typing import Any

import pytest

from tests.helpers.constructed.separations import CROSSING, point
from tests.helpers.maps import by_formulas
from tests.unit.pages.test_page import EVIL, Reader, claim, proof, report, run, scene
from verify import Hamiltonian, Proof, prove, separate_grid
from verify import run as run_scheme
from verify.schemes import get
from verify.verdict import Verdict

DUFFING = Hamiltonian.parse("p**2/2 + q**2/2 + delta*q**4/4", {"delta": 1})


def proved(scheme: str, exact: Hamiltonian = DUFFING) -> Proof:
    return prove(get(scheme).step_map(exact), get(scheme))


def cells(shown: str) -> list[str]:
    """The texts of the table; AssertionError where it is not well-formed, or needs anything."""
    reader = Reader(shown)
    tags = {tag for tag, _ in reader.elements}
    assert tags <= {"table", "caption", "thead", "tbody", "tr", "th", "td", "p"}
    for tag, attributes in reader.elements:
        assert set(attributes) <= {"scope", "style"}, tag
        assert not re.search(r"color|background|url", attributes.get("style") or "")
    return reader.texts


# -- proofs ---------------------------------------------------------------------------------------


def test_a_proof_shows_order_leading_coefficient_and_closed_form() -> None:
    texts = cells(proved("lie2")._repr_html_())
    assert "3" in texts
    assert "3*p*q" in texts
    assert {"order of ΔJ", "leading coefficient"} <= set(texts)
    assert any(text.startswith("PROVED: ") for text in texts)
    assert not any("det J ≡ 1: the map" in text for text in texts)
    formula = proved("lie2")._repr_latex_()
    assert formula.startswith("$$")
    assert r"\left(3 p q\right) h^{3} + O(h^{4})" in formula
    assert r"\equiv 1" not in formula


def test_a_proof_of_area_preservation_shows_det_j_is_1() -> None:
    texts = cells(proved("stormer-verlet")._repr_html_())
    assert any("det J ≡ 1: the map" in text for text in texts)
    assert not {"order of ΔJ", "leading coefficient"} & set(texts), "ΔJ has none"
    formula = proved("stormer-verlet")._repr_latex_()
    assert r"\det J &\equiv 1" in formula
    assert r"\Delta J" not in formula


def test_what_is_too_long_is_not_typeset() -> None:
    assert len(proved("lie8")._repr_latex_()) < 4000


# -- runs -----------------------------------------------------------------------------------------


def test_a_run_shows_its_values_with_their_bounds() -> None:
    found = run_scheme(DUFFING, "lie2", q="1.5", p=0, step_size="0.01", steps=50)
    texts = cells(found._repr_html_())
    formula = found._repr_latex_()
    assert found.values
    for value in found.values.values():
        assert value.value in texts
        assert f"± {value.bound}" in texts
        assert value.value.partition("e")[0] in formula
    assert any(found.error_kind in text for text in texts)


@pytest.mark.parametrize("status", ["left range", "unresolved"])
def test_a_run_without_values_says_why(status: Any) -> None:
    found = run(status=status, failed_step=7, values={})
    assert f"{status} at step 7" in cells(found._repr_html_())
    assert status in found._repr_latex_()


# -- separations ----------------------------------------------------------------------------------


def test_a_separation_shows_every_part_with_its_bound() -> None:
    grid = separate_grid(DUFFING, "lie2", q="1.5", p=0, step_sizes=["0.01"], steps=50)
    (found,) = grid.points
    assert grid._repr_html_() == found._repr_html_()
    texts = cells(found._repr_html_())
    assert found.plain is not None
    for name in type(found.plain.parts).model_fields:
        value = getattr(found.plain.parts, name)
        assert any(text.startswith(value.value) and value.bound in text for text in texts), name


def test_a_grid_shows_every_step_size_and_the_crossover() -> None:
    texts = cells(CROSSING._repr_html_())
    assert {found.step_size for found in CROSSING.points} <= set(texts)
    assert CROSSING.plain.step_size is not None
    assert any(f"below h = {CROSSING.plain.step_size}" in text for text in texts)
    failed = point("0.1", None, None, status="left range", reason="too far")
    assert "too far" in cells(failed._repr_html_())


# -- reports, and hostile text --------------------------------------------------------------------


def test_a_report_shows_its_verdicts_and_the_refuted_first() -> None:
    claims = (claim(id="a"), claim(id="b", verdict=Verdict.REFUTED))
    texts = cells(report(claims=claims)._repr_html_())
    assert texts.index("b") < texts.index("a")
    assert "1 proved, 1 refuted" in texts
    assert "lie2" in cells(report((scene(),))._repr_html_())


def test_what_others_wrote_stays_text() -> None:
    shown = [
        run(scheme=EVIL, error_method=EVIL, fallback=EVIL)._repr_html_(),
        point("0.1", None, None, scheme=EVIL, reason=EVIL)._repr_html_(),
        report((scene(title=EVIL, proofs=(proof(scheme=EVIL, reason=EVIL),)),))._repr_html_(),
        report(title=EVIL, claims=(claim(id=EVIL, source=EVIL, evidence=EVIL),))._repr_html_(),
    ]
    for each in shown:
        assert any(EVIL in text for text in cells(each))


def test_the_check_sees_what_is_not_escaped() -> None:
    with pytest.raises(AssertionError):
        cells(f"<table><tr><td>{EVIL}</td></tr></table>")


def test_a_map_of_ones_own_shows_itself() -> None:
    own = prove(by_formulas(DUFFING, "p - h*(q + q**3)", "q + h*p_next"))
    assert r"\det J &\equiv 1" in own._repr_latex_()
