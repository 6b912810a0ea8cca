"""The page's markup as LaTeX for the standard classes: pdfLaTeX with amsmath, nothing else."""

import re
from unicodedata import decomposition, normalize

from verify.pages.markdown.inline_text import tex, tex_character
from verify.pages.markdown.markup import MarkupNode, tree
from verify.pages.text.prose_markup import cell, prose, sentence

_SPECIAL = {
    **{c: rf"\{c}" for c in "#$%&_{}"},
    "\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}",
    "`": r"\`{}", "“": "``", "”": "''", "’": "'", "‘": "`", "–": "--", "—": "---",
    "\u00a0": "~", "\u2009": r"\,", "\u202f": r"\,", "\u00ad": r"\-", "\u2010": "-", "\u2011": "-",
    "\u200b": "", "\u2060": "{}", "\u2061": "", "\u2062": "", "√": r"\ensuremath{\surd}",
    "<": r"\ensuremath{<}", ">": r"\ensuremath{>}", "|": r"\ensuremath{|}", "−": r"\ensuremath{-}",
    "°": r"\ensuremath{^{\circ}}", "÷": r"\ensuremath{\div}", "¬": r"\ensuremath{\neg}",
    "§": r"\S{}", "¶": r"\P{}", "©": r"\copyright{}", "£": r"\pounds{}", "„": r"\quotedblbase{}",
    "«": r"\guillemotleft{}", "»": r"\guillemotright{}", "‚": r"\quotesinglbase{}",
    "¡": r"\textexclamdown{}", "¿": r"\textquestiondown{}", "ħ": r"\ensuremath{\hbar}",
}  # fmt: skip
# TeX reads two of these as one sign: a dash, or a quotation mark.
_LIGATURE = re.compile(r"([-',])(?=\1)")
# Latin letters that the encoding T1 does not have.
_NOT_IN_T1 = set("ĦħĸĿŀŉŦŧſ")
_ACCENTS = {"\u0304": "bar", "\u0303": "tilde", "\u0307": "dot", "\u0308": "ddot"}
_ACCENTED = re.compile(f"[^\\W\\d_][{''.join(_ACCENTS)}]")
_DECIMAL = re.compile(r"-?[0-9]+(\.[0-9]+)?", re.ASCII)
_FRACTION = re.compile("([0-9]+)\N{FRACTION SLASH}([0-9]+)")
_TAGS = {"sub": r"\textsubscript", "sup": r"\textsuperscript", "i": r"\emph", "em": r"\emph",
         "b": r"\textbf", "strong": r"\textbf", "code": r"\texttt"}  # fmt: skip


def _list_shifted(kind: str) -> str:
    """Return the characters that Unicode calls raised, `<super>`, or lowered, `<sub>`."""
    return "".join(
        c
        for c in map(chr, range(0xA0, 0x2D00))
        if decomposition(c).startswith(kind) and tex_character(normalize("NFKC", c)) != "?"
    )


_RAISED, _LOWERED = (re.compile(f"[{_list_shifted(kind)}]+") for kind in ("<super>", "<sub>"))


def latex(text: str) -> str:
    """Return prose, with its formulas, as LaTeX in one line."""
    return _line(tree(prose(text)))


def latex_sentence(text: str) -> str:
    """Return prose as a sentence in LaTeX."""
    return _line(tree(sentence(text)))


def latex_cell(text: str) -> str:
    """Return a table's cell in LaTeX: a decimal, which is copied with its digits, or prose."""
    return f"${text}$" if _DECIMAL.fullmatch(text) else _line(tree(cell(text)))


def _line(node: MarkupNode) -> str:
    return re.sub(r"\s+", " ", "".join(map(_inline, node.children))).strip()


def _inline(node: MarkupNode | str) -> str:
    if isinstance(node, str):
        return escape(node)
    if node.tag == "math":
        # Two names are MathJax's alone.
        formula = tex(node).replace(r"\lt ", "<").replace(r"\gt ", ">")
        return f"${formula.strip()}$"
    inner = "".join(map(_inline, node.children))
    command = _TAGS.get(node.tag)
    return f"{command}{{{inner}}}" if command else inner


def escape(text: str) -> str:
    """Return plain text as LaTeX; a character that LaTeX has no sign for becomes its number."""
    text = _LIGATURE.sub("\\1\u2060", normalize("NFC", text))
    parts = re.split(f"({_RAISED.pattern}|{_LOWERED.pattern}|{_ACCENTED.pattern})", text)
    return "".join(map(_escape_part, parts))


def _escape_part(part: str) -> str:
    """Return an index or power, a letter with an accent that has no code point, or plain text."""
    for pattern, mark in ((_RAISED, "^"), (_LOWERED, "_")):
        if pattern.fullmatch(part):
            signs = "".join(map(tex_character, normalize("NFKC", part)))
            return rf"\ensuremath{{{mark}{{{signs.strip()}}}}}"
    return _accent_letter(part) or "".join(map(_escape_character, part))


def _accent_letter(letter: str) -> str:
    """Return a letter with one of the accents of formulas; "" for all other texts."""
    if not _ACCENTED.fullmatch(letter) or (sign := tex_character(letter[0])) == "?":
        return ""
    return rf"\ensuremath{{\{_ACCENTS[letter[1]]}{{{sign.strip()}}}}}"


def _escape_character(c: str) -> str:
    if c in _SPECIAL:
        return _SPECIAL[c]
    if c.isspace():
        return " "
    if c.isascii() and c.isprintable():
        return c
    if "\u00c0" <= c <= "\u017f" and c.isalpha() and c not in _NOT_IN_T1:
        return c
    if fraction := _FRACTION.fullmatch(normalize("NFKC", c)):
        return rf"\ensuremath{{\tfrac{{{fraction[1]}}}{{{fraction[2]}}}}}"
    if accented := _accent_letter(normalize("NFD", c)):
        return accented
    sign = tex_character(c)
    return f"[U+{ord(c):04X}]" if sign == "?" else rf"\ensuremath{{{sign.strip()}}}"
