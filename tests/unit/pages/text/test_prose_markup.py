"""Sentences as the pages set them: by their parts."""

import pytest

from verify.pages.text.prose_markup import cell, prose, prose_with_backticks, sentence
from verify.prose import Formula, Number, Prose


@pytest.mark.parametrize(
    ("text", "markup"),
    [
        ("`ΔJ_k` = O(`h^4`)", "ΔJ<sub>k</sub> = O(h⁴)"),
        ("`z̄_(k+1)`", "z̄<sub>k+1</sub>"),
        ("`h^η` `X^(η−k)`", "h<sup>η</sup> X<sup>η−k</sup>"),
        ("`(−D)^((η+1)/2)`", "(−D)<sup>(η+1)/2</sup>"),
        ("(1 + h`L_p`)", "(1 + hL<sub>p</sub>)"),
        ("from `-21.95` to `2.6e+05`", "from −21.95 to 2.6\xa0×\xa010⁵"),
        ("q = `0.1`, p = `-1`", "q\xa0=\xa00.1, p\xa0=\xa0−1"),
        ("it is `[0.5 +/- 2e-13]`", "0.5\xa0±\xa02\xa0×\xa010⁻¹³"),
        ("the difference is `h**2*q`", "the difference is <math>"),
        ("a <b> & 2 * 3 of them", "a &lt;b&gt; &amp; 2 * 3 of them"),
        ("p_next, H_qq, h^3, -1e-5 and x-1 stay", "p_next, H_qq, h^3, -1e-5 and x-1 stay"),
    ],
)
def test_what_people_write_is_set_with_what_they_quote(text: str, markup: str) -> None:
    assert markup in prose_with_backticks(text)


@pytest.mark.parametrize(
    ("part", "markup"),
    [
        ("2*q and H_qq, -1e-5, h^3", "2*q and H_qq, -1e-5, h^3"),
        ("<b>&", "&lt;b&gt;&amp;"),
        (Number("-2.1e-06"), "−2.1\xa0×\xa010⁻⁶"),
        (Formula("h**2*q"), "<math>"),
        (Formula("h^12"), "h¹²"),
        (Formula("O(hε^12)"), "O(hε<sup>12</sup>)"),
        (Formula("e^(Nε)"), "e<sup>Nε</sup>"),
        (Formula("L_{H_p}"), "L<sub>H<sub>p</sub></sub>"),
        (Formula("H_qq"), "H<sub>qq</sub>"),
        (Formula("delta"), "<mi>δ</mi>"),
        (Formula("<b>^2"), "&lt;b&gt;"),
    ],
)
def test_a_prose_is_set_by_its_parts(part: str, markup: str) -> None:
    shown = prose(Prose("it is ", part, " here"))
    assert markup in shown
    assert shown.startswith("it is ")
    assert shown.endswith(" here")


def test_a_star_in_a_text_is_no_formula() -> None:
    said = "2 * 3 of them, h**2*q"
    assert prose(Prose(said)) == prose(said) == said
    assert "<math>" in prose(Prose(Formula(said.split(", ")[1])))


def test_a_sentence_and_a_cell_keep_their_parts() -> None:
    found = sentence(Prose("the rest is ", Formula("h**2"), " * x"))
    assert found.startswith("The rest is <math>")
    assert found.endswith(" * x.")
    assert sentence(Prose(Formula("ε^k"), " is.")) == "ε<sup>k</sup> is."
    assert sentence(Prose()) == "."
    assert cell(Prose(Number("-1.5"))) == "−1.5"
    assert cell(Prose("a * b")) == "a * b"


def test_a_name_and_its_value_stay_on_one_line_and_a_long_formula_may_break() -> None:
    short = prose(Prose("at ", Formula("p"), " = ", Number("7/17"), "."))
    assert '<span class="nowrap"><math><mrow><mi>p</mi></mrow></math> = 7/17</span>.' in short
    long = prose(Prose(Formula("3*p*q + sin(q)**2*p**4"), " = ", Number("1")))
    assert "nowrap" not in long
