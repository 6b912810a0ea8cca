"""Formulas on lines of their own: what is bound to what, and nothing lost or let through."""

import re
from collections.abc import Iterable
from html import unescape

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.examples import drawn
from verify.pages.markdown.inline_text import tex
from verify.pages.markdown.markup import MarkupNode, tree
from verify.pages.text.display_math import display_formula
from verify.pages.text.prose_markup import prose
from verify.papers import check_theorem, names
from verify.proof.proof_for_every_h import STEPS
from verify.prose import Display, Prose, read_prose


def as_tex(text: str) -> str:
    return tex(tree(display_formula(text)))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("z_k", "z_{k}"),
        ("E_{k+1}", "E_{k+1}"),
        ("h^(η+1)", r"h^{\eta +1}"),
        ("x_k^2", "x_{k}^{2}"),
        ("h³ and".removesuffix(" and"), "h^{3}"),
        ("‖J_k‖₂", r"{\Vert J_{k}\Vert }_{2}"),
        ("z̄_k", r"{\bar{z}}_{k}"),
        ("pq", "pq"),
        ("p q", r"p\,q"),
        ("det J", r"\mathrm{det}\,J"),
        ("√h q", r"\sqrt{h}\,q"),
        ("√MSE", r"\sqrt{\mathrm{MSE}}"),
        ("q''", "q''"),
        ("(η+1)!", r"(\eta +1)!"),
        ("−x", "-x"),
        ("e^(−T)", "e^{-T}"),
        ('x = 1 "for all" k', r"x=1\mathrm{\ for all\ }k"),
    ],
)
def test_indices_powers_and_words_are_bound_as_written(text: str, told: str) -> None:
    assert as_tex(text) == told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("h/2", r"\frac{h}{2}"),
        ("dH/dt = 0", r"\frac{dH}{dt}=0"),
        ("M h^η/(η+1)! x", r"M\,\frac{h^{\eta }}{(\eta +1)!}\,x"),
        ("(a + b)/(c + d)", r"\frac{a+b}{c+d}"),
        ("f(sz)/s", r"\frac{f(sz)}{s}"),
        ("(1/N) x", r"\frac{1}{N}\,x"),
        ("(1/N)^2", r"{\left(\frac{1}{N}\right)}^{2}"),
        ("|h|/2", r"\frac{\vert h\vert }{2}"),
        ("−div(X f)/2!", r"-\frac{\mathrm{div}(X\,f)}{2!}"),
        ("e^(m/h)", "e^{m/h}"),
        ("a/b + c/d", r"\frac{a}{b}+\frac{c}{d}"),
    ],
)  # fmt: skip
def test_a_fraction_reaches_to_the_next_space(text: str, told: str) -> None:
    assert as_tex(text) == told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("|a − c| ≤ |a|", r"\vert a-c\vert \le \vert a\vert "),
        ("| |b| − |a| | ≤ 1", r"\vert \vert b\vert -\vert a\vert \vert \le 1"),
        ("Σ_{k} |x_k|", r"\sum _{k}\,\vert x_{k}\vert "),
        ("f(|x|, |y|)", r"f(\vert x\vert ,\vert y\vert )"),
        ("Σ_{n=0}^{η} h^n", r"\sum _{n=0}^{\eta }\,h^{n}"),
        ("max_{k} x_k", r"\max _{k}\,x_{k}"),
        ("∫_0^t f dt", r"{\int }_{0}^{t}\,f\,dt"),
    ],
)
def test_bars_are_opened_and_closed_and_sums_have_their_limits(text: str, told: str) -> None:
    assert as_tex(text) == told


def test_a_long_chain_has_a_row_for_each_relation_and_a_long_sum_for_each_term() -> None:
    chain = "E_{k+1} ≤ (1 + hL) E_k + C h^(η+1) ≤ (1 + hL)(1 + hL) E_{k−1} + 2C h^(η+1)"
    assert as_tex(chain).count(r"\\") == 1
    total = "ΔJ = (h/2)(T'T''V''' − V'V''T''') + (h/4)(T''V'' − T'T'''V'V''')"
    assert as_tex(total).count(r"\\") == 1
    assert "mtable" not in display_formula("|Λ| ≤ e^(Nε) − 1")


def test_the_stop_that_ends_a_formula_stands_in_its_line() -> None:
    found = str(prose(read_prose("so that ``x = 1``. Then ``y = 2``, and so on")))
    assert "<mtext>.</mtext></math> Then" in found
    assert "<mtext>,</mtext></math> and so on" in found
    assert found.count("<math display") == 2


def test_people_quote_a_line_of_its_own_twice() -> None:
    found = read_prose("by `h^2` ``x ≤ y`` and `1.5`")
    assert [type(part).__name__ for part in found.parts] == [
        "str", "Formula", "str", "Display", "str", "Number",
    ]  # fmt: skip
    assert found == "by h^2 x ≤ y and 1.5"
    assert Prose.from_data(found.as_data()).parts == found.parts


def displays(texts: Iterable[Prose]) -> list[str]:
    return [str(p) for text in texts for p in text.parts if isinstance(p, Display)]


@pytest.mark.left_to_ci
@pytest.mark.sample(16)
@pytest.mark.parametrize("name", names())
def test_every_formula_of_an_argument_is_set_whole(name: str) -> None:
    theorem = check_theorem(name)
    for text in displays([theorem.given, *(step.text for step in theorem.steps)]):
        is_set_whole(text)


def test_so_is_every_formula_of_the_argument_by_lie_derivatives() -> None:
    for text in displays(read_prose(text) for text, _ in STEPS):
        is_set_whole(text)


def is_set_whole(text: str) -> None:
    markup = display_formula(text)
    shown = unescape(re.sub("<[^>]*>", "", markup))
    plain = re.sub(r"[\s{}()_^/\"|‖.,;:√=]", "", text.translate(_SPELT))
    assert sorted(re.sub(r"[\s()/|‖.,;:=]", "", shown.translate(_SPELT))) == sorted(plain), text
    assert "?" not in as_tex(text), text
    assert "_" not in shown, text
    assert "^" not in shown, text


_SPELT = str.maketrans(
    {"∑": "Σ", "∏": "Π", "′": "'", "\u00a0": "", "-": "−", "²": "2", "³": "3", "⁴": "4", "₂": "2",
     "ᵀ": "T"}
)  # fmt: skip


@pytest.mark.left_to_ci
@drawn(200)
@given(st.text(max_size=40))
def test_any_text_is_set_and_escaped(text: str) -> None:
    def tags(node: MarkupNode) -> set[str]:
        return {node.tag} | {tag for child in node.elements() for tag in tags(child)}

    found = tags(tree(display_formula(text)))
    assert all(tag == "" or re.fullmatch("m[a-z]+", tag) for tag in found)
