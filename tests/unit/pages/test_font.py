"""The font that a page carries has each letter and sign of its formulas."""

import html
import re
import unicodedata

import pytest
from fontTools.ttLib import TTFont

from tests.browser.made_pages import NAMES, page_of
from verify.pages.page import FONT

_FORMULA = re.compile(r"<math.*?</math>", re.DOTALL)
_LETTER = re.compile(r"<mi>(\w)</mi>")


def letters(page: str) -> set[str]:
    """The characters of all formulas, and the slanted form of a letter that stands alone."""
    formulas = "".join(_FORMULA.findall(page))
    slanted = {_slanted(letter) for letter in _LETTER.findall(formulas)}
    return set(html.unescape(re.sub("<[^>]*>|\\s", "", formulas))) | slanted


def _slanted(letter: str) -> str:
    if letter == "h":
        return "\u210e"  # the constant of Planck, which stands in for the slanted h
    name = unicodedata.name(letter)
    return unicodedata.lookup(
        re.sub("(LATIN|GREEK) (SMALL|CAPITAL) LETTER", r"MATHEMATICAL ITALIC \2", name)
    )


@pytest.mark.parametrize("name", NAMES)
def test_each_sign_of_a_pages_formulas_is_in_the_font(name: str) -> None:
    font = TTFont(FONT)
    assert "MATH" in font, "superscripts and fractions are placed by it"
    needed = letters(page_of(name))
    assert len(needed) > 10
    assert needed <= {chr(code) for code in font.getBestCmap()}


def test_a_sign_that_is_not_there_is_seen() -> None:
    needed = letters("<p>щ</p><math><mi>ж</mi><mi>δ</mi></math>")
    assert needed == {"ж", "δ", "𝛿"}
    assert needed - {chr(code) for code in TTFont(FONT).getBestCmap()} == {"ж"}
