"""Texts as LaTeX: what LaTeX would read in a special way is shown, and no sign of ours is lost."""

import string
import tomllib
import unicodedata
from collections.abc import Iterator
from itertools import product
from typing import Any

import pytest

from tests.helpers.constructed.scenes import PAPER
from tests.helpers.pages.read_latex import commands, shown
from verify.pages.errata.latex import escape, latex, latex_cell, latex_sentence
from verify.prose import Display, Formula, Number, prose, read_prose

PRINTABLE = string.ascii_letters + string.digits + string.punctuation + " "
CLAIMS = (PAPER / "claims.toml").read_text(encoding="utf-8")

# -- plain text -----------------------------------------------------------------------------------

SPECIAL = {
    "#": r"\#", "$": r"\$", "%": r"\%", "&": r"\&", "_": r"\_", "{": r"\{", "}": r"\}",
    "\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}",
}  # fmt: skip


@pytest.mark.parametrize("character", SPECIAL)
def test_each_special_character_of_latex_is_escaped(character: str) -> None:
    assert escape(f"a{character}b") == f"a{SPECIAL[character]}b"


def test_all_ascii_text_is_shown_as_it_is_and_no_two_characters_become_one_sign() -> None:
    """Two hyphens would become a dash, and two commas a quotation mark."""
    pairs = {"".join(pair) for pair in product(PRINTABLE, repeat=2)}
    assert [text for text in pairs if shown(escape(text)) != text] == []
    assert shown(escape("a --- b,,,c '''")) == "a --- b,,,c '''"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("“a” ‘b’ c’s", "``a'' `b' c's"),
        ("1–3 — x", "1--3 --- x"),
        ("10⁻⁶ hⁿ⁺¹ m²", r"10\ensuremath{^{-6}} h\ensuremath{^{n+1}} m\ensuremath{^{2}}"),
        ("Jᵀ xⁱ", r"J\ensuremath{^{T}} x\ensuremath{^{i}}"),
        ("z₀ z₍ₖ₊₁₎", r"z\ensuremath{_{0}} z\ensuremath{_{(k+1)}}"),
        ("Δη", r"\ensuremath{\Delta}\ensuremath{\eta}"),
        ("p̄ p̃ q̇ C̃", r"\ensuremath{\bar{p}} \ensuremath{\tilde{p}} "
         r"\ensuremath{\dot{q}} \ensuremath{\tilde{C}}"),
        ("ṗ ẍ ỹ", r"\ensuremath{\dot{p}} \ensuremath{\ddot{x}} \ensuremath{\tilde{y}}"),
        ("θ̇", r"\ensuremath{\dot{\theta}}"),
        ("Störmer, Hénon", "Störmer, Hénon"),
        ("½ 3⅔", r"\ensuremath{\tfrac{1}{2}} 3\ensuremath{\tfrac{2}{3}}"),
        ("√ ∞ ∂ ∫ Σ", r"\ensuremath{\surd} \ensuremath{\infty} \ensuremath{\partial} "
         r"\ensuremath{\int} \ensuremath{\Sigma}"),
        ("≤≥≠≡≈", r"\ensuremath{\le}\ensuremath{\ge}\ensuremath{\ne}\ensuremath{\equiv}"
         r"\ensuremath{\approx}"),
        ("−·×…‖ℓ", r"\ensuremath{-}\ensuremath{\cdot}\ensuremath{\times}\ensuremath{\dots}"
         r"\ensuremath{\Vert}\ensuremath{\ell}"),
        ("a\u00a0b\u2009c\u202fd", r"a~b\,c\,d"),
        ("5° §", r"5\ensuremath{^{\circ}} \S{}"),
    ],
)  # fmt: skip
def test_signs_become_those_of_latex(text: str, expected: str) -> None:
    assert escape(unicodedata.normalize("NFC", text)) == expected
    assert escape(unicodedata.normalize("NFD", text)) == expected


@pytest.mark.parametrize(
    ("text", "number"),
    [("☃", "2603"), ("\U0001f600", "1F600"), ("Ŧ", "0166"), ("\x00", "0000"), ("\x7f", "007F"),
     ("\u0303", "0303"), ("™", "2122"), ("\ud800", "D800")],
    ids=ascii,
)  # fmt: skip
def test_a_sign_that_latex_does_not_have_is_its_number(text: str, number: str) -> None:
    assert escape(f"a {text} b") == f"a [U+{number}] b"


def test_no_text_ends_a_paragraph_or_a_line() -> None:
    """A blank line within an argument is an error of LaTeX."""
    assert escape("a\n\nb\tc\u2028d\x1ee") == "a  b c d e"
    assert latex("a\n\n\nb") == "a b"


# -- the signs of the paper's claims --------------------------------------------------------------


def texts(value: Any) -> Iterator[str]:
    """All texts in a file that is read as TOML."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        yield from (text for each in value.values() for text in texts(each))
    elif isinstance(value, list):
        yield from (text for each in value for text in texts(each))


SIGNS = sorted({c for c in CLAIMS if not c.isascii() and not unicodedata.combining(c)})


@pytest.mark.parametrize("sign", SIGNS)
def test_each_sign_of_the_papers_claims_is_one_of_latex(sign: str) -> None:
    written = escape(f"x{sign}y")
    assert "[U+" not in written
    assert written.isascii()


def test_every_text_of_the_papers_claims_is_latex_in_ascii() -> None:
    """A formula shows a sign that TeX does not have as a question mark."""
    written = {text: latex(read_prose(text)) for text in texts(tomllib.loads(CLAIMS))}
    assert len(written) > 500
    assert [w for w in written.values() if "[U+" in w or not w.isascii()] == []
    assert [w for text, w in written.items() if w.count("?") != text.count("?")] == []


# -- prose ----------------------------------------------------------------------------------------


def test_formulas_and_numbers_are_set_as_on_the_page() -> None:
    written = latex(prose("H = ", Formula("p**2/2 - cos(q)"), " at ", Number("-1.5e-07"), ", 50 %"))
    assert "".join(written.split()) == (
        r"H=$\tfrac{1}{2}\,p^{2}-\cosq$at\ensuremath{-}1.5~\ensuremath{\times}~10\ensuremath{^{-7}}"
        r",50\%"
    )
    assert latex(read_prose("`e^p_{k+1}` of `L_{H_p}`")) == (
        r"e\textsuperscript{p}\textsubscript{k+1} of L\textsubscript{H\textsubscript{p}}"
    )


def test_no_name_is_used_that_only_mathjax_has() -> None:
    written = latex(prose(Display("|Λ| < 1 > 0")))
    assert not {"lt", "gt"} & commands(written)
    assert "<" in written
    assert ">" in written


def test_a_sentence_has_a_capital_and_a_stop() -> None:
    assert latex_sentence("it is 5 % of it") == r"It is 5 \% of it."


@pytest.mark.parametrize(
    ("cell", "expected"),
    [("-1.3010", "$-1.3010$"), ("0.001", "$0.001$"), ("1/30", "1/30"),
     ("-2e-05", r"\ensuremath{-}2~\ensuremath{\times}~10\ensuremath{^{-5}}"),
     ("left range & more", r"left range \& more"), ("1$", r"1\$")],
)  # fmt: skip
def test_a_decimal_keeps_its_digits_in_a_cell_and_all_else_is_text(
    cell: str, expected: str
) -> None:
    assert latex_cell(cell) == expected


HOSTILE = [
    r"\input{/etc/passwd}", r"\write18{ls}", "}", "$", "$$", "% all", "a & b \\\\", "#1", "^^41",
    r"\end{document}", "`\\csname x\\endcsname`", "{_{^{", "~~", r"\[ x \]",
]  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_text_is_shown_as_text_and_starts_no_command(text: str) -> None:
    assert shown(latex(text)) == text
    assert shown(escape(text)) == text
    assert commands(latex(text)) <= {"textbackslash", "textasciicircum", "textasciitilde"}


OURS = {"textbackslash", "textasciicircum", "textasciitilde", "textsubscript", "textsuperscript",
        "ensuremath", "left", "right", "mathrm", "frac"}  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("kind", [Formula, Display])
def test_hostile_formulas_start_no_command_and_balance_their_braces(
    text: str, kind: type[str]
) -> None:
    for formula in (text, f"a_{{{text}}}", f"x^({text})", f"p**2 + {text}"):
        written = latex(prose("so ", kind(formula), " it is"))
        assert commands(written) <= OURS
        unescaped = written.replace("\\{", "").replace("\\}", "").replace("\\$", "")
        assert unescaped.count("{") == unescaped.count("}")
        assert unescaped.count("$") in (0, 2)
        assert "%" not in unescaped.replace("\\%", "")
