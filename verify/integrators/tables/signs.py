"""Numbers as papers and programs print them, written as formulas are here.

plain("−½ × 10⁻³")           -(1/2)*10^(-3)
plain("\\\\frac{\\\\sqrt{3}}{6}")   ((sqrt(3))/(6))
plain("0.5d-1")              0.5e-1
"""

import re
import unicodedata

LONGEST = 2000  # characters of a number, or of a formula of some
_SIGNS = {
    **dict.fromkeys("−–‒‐‑﹣－", "-"),
    **dict.fromkeys("⁄∕÷", "/"),
    **dict.fromkeys("×·⋅∗•", "*"),
    **dict.fromkeys(" \u00a0\u2009\u202f\u2002\u2003", " "),
    "＋": "+", "π": "pi",
}  # fmt: skip
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_LATEX = (
    (re.compile(r"\\(?:left|right|displaystyle|,|;|!|quad|hfill)|[$~]"), " "),
    (re.compile(r"\\(?:cdot|times)\b"), "*"),
    (re.compile(r"\\pi\b"), "pi"),
)
_FRACTION = re.compile(r"\\[dt]?frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}|\\[dt]?frac\s*(\d)\s*(\d)")
_ROOT = re.compile(r"\\sqrt\s*\{([^{}]*)\}")
_SIGN_OF_ROOT = re.compile(r"√\s*(\d+(?:\.\d+)?|\([^()]*\))")
_TEN = re.compile(r"(?<=\d)\s*\*\s*10\s*(?:\^|\*\*)\s*[({]?\s*([+-]?\d+)\s*[)}]?")
_FORTRAN = re.compile(r"(?<=[\d.])[dD](?=[+-]?\d)")
_GROUPED = re.compile(r"\d*\.\d+(?: \d+)+(?![\d/.])")


def plain(text: str) -> str:
    """Write the same number in the signs of formulas; leave what is none for the formula's
    reader."""
    text = "".join(_SIGNS.get(x, x) for x in text)
    text = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺]+", lambda m: f"^({m[0].translate(_RAISED)})", text)
    text = "".join(_vulgar(x) for x in text)
    for pattern, instead in _LATEX:
        text = pattern.sub(instead, text)
    for _ in range(8):  # from the inside out
        before = text
        text = _ROOT.sub(r"(sqrt(\1))", text)
        text = _FRACTION.sub(lambda m: f"(({m[1] or m[3]})/({m[2] or m[4]}))", text)
        if text == before:
            break
    text = _SIGN_OF_ROOT.sub(r"sqrt(\1)", text)
    text = re.sub(r"(?<=[\d)])\s*(?=\(*sqrt)", "*", text)
    text = _TEN.sub(r"e\1", text)
    text = _FORTRAN.sub("e", text)
    text = _GROUPED.sub(lambda m: m[0].replace(" ", ""), text.strip())
    return re.sub(r"\s*([/*()+-])\s*", r"\1", text)


def _vulgar(x: str) -> str:
    """Write ½ and the like, which stand for two numbers and a bar, as a quotient."""
    parts = unicodedata.normalize("NFKC", x)
    return f"({parts.replace(chr(0x2044), '/')})" if chr(0x2044) in parts and len(parts) > 1 else x
