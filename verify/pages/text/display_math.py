"""Conversion of a displayed formula, in the notation of prose, to MathML Core by a small reader.

    |Λ| ≤ (1 + ε)^N − 1 ≤ e^(Nε) − 1        Σ_{n=0}^{η} h^n/n! X^n z        "where" D ≠ 0

Letters side by side are a product, except in the words of `_WORDS`. Each side of a `/` reaches to
the next space, or is in brackets. Such brackets are not shown, nor are those after `_` and `^`. A
long formula is set in several rows. A sign that is not recognised is set unchanged.
"""

import re

from markupsafe import Markup, escape

from verify.functions import by_name
from verify.pages.text.pieces import (
    Kind,
    Piece,
    as_element,
    attach_scripts,
    pop_operand,
    side_by_side,
    split_rows,
    strip_brackets,
)

_WORDS = {
    "det", "div", "tr", "adj", "Hess", "log", "max", "min", "lim", "MSE", "area", "const", "end",
    *(f.shown for f in by_name().values()),
}  # fmt: skip
# Operators whose index is set below them.
_INDEXED_BELOW = {"Σ", "Π", "max", "min", "lim"}
_LARGE_OPERATORS = {"Σ": "∑", "Π": "∏", "∫": "∫", "∂": "∂", "∇": "∇"}
_RELATIONS = set("=≠<>≤≥≡→↦∈≈⇒⇔")
_OPERATORS = set("+−-·×∘∧,;:…±∪∩") | _RELATIONS
_BRACKETS = {"(": ")", "[": "]", "⟨": "⟩"}
_SUPERSCRIPT_DIGITS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺ⁿᵀᵏ", "0123456789−+nTk")
_SUBSCRIPT_DIGITS = str.maketrans("₀₁₂₃₄₅₆₇₈₉ₖₙₜ", "0123456789knt")
_SUPERSCRIPT, _SUBSCRIPT = (
    "".join(map(chr, table)) for table in (_SUPERSCRIPT_DIGITS, _SUBSCRIPT_DIGITS)
)
_TOKEN = re.compile(
    rf'"(?P<text>[^"]*)"|(?P<number>[0-9]+(?:\.[0-9]+)?)|(?P<word>[A-Za-z]+)[\u0300-\u036f]?'
    rf"|(?P<raised>[{_SUPERSCRIPT}]+)|(?P<lowered>[{_SUBSCRIPT}]+)|(?P<sign>.)",
    re.DOTALL,
)
_SCRIPT = re.compile(r"[−-]?(?:[0-9]+|[A-Za-z]+|[\u0370-\u03ff])")


def display_formula(text: str, end: str = "") -> Markup:
    """Return the formula as a block of its own, followed by `end`, a stop or a comma."""
    reader = _FormulaReader(" ".join(text.split()))
    rows = split_rows(reader.read_pieces(""))
    if end:
        rows[-1].append(Piece(f"<mtext>{escape(end)}</mtext>"))
    if len(rows) == 1:
        content = side_by_side(rows[0])
    else:
        lines = "".join(f'<mtr><mtd class="l">{side_by_side(row)}</mtd></mtr>' for row in rows)
        content = f'<mtable displaystyle="true">{lines}</mtable>'
    return Markup(f'<math display="block">{content}</math>')  # noqa: S704 - leaves are escaped


class _FormulaReader:
    def __init__(self, text: str) -> None:
        self.text = text
        self.position = 0
        self.script_depth = 0  # the number of scripts around the text, one in another

    def read_pieces(self, end: str) -> list[Piece]:
        """Read the pieces up to the sign `end`, and skip that sign."""
        pieces: list[Piece] = []
        while self.position < len(self.text):
            is_apart = self._skip_spaces()
            if self.position >= len(self.text) or self._is_end(end):
                break
            if self._peek() == "/" and pieces:
                self.position += 1
                numerator = pop_operand(pieces)
                pieces.append(self._set_fraction(numerator, self._read_product(end)))
                continue
            piece = self._read_scripts(self._read_atom())
            piece.is_apart = is_apart
            pieces.append(piece)
        self.position += bool(end)
        return pieces

    def _peek(self) -> str:
        return self.text[self.position : self.position + 1]

    def _skip_spaces(self) -> bool:
        start = self.position
        while self._peek() == " ":
            self.position += 1
        return self.position > start

    def _is_end(self, end: str) -> bool:
        # An opening and a closing bar are the same sign. It closes if it stands after a symbol, or
        # before the end, a space, a comma or a closing bracket.
        if end in ("|", "‖") and self._peek() == end:
            sign_before = self.text[self.position - 1]
            sign_after = self.text[self.position + 1 : self.position + 2]
            return sign_before not in " (," or sign_after in ("", " ", ")", ",")
        return bool(end) and self._peek() == end

    # -- atoms ------------------------------------------------------------------------------------

    def _read_atom(self) -> Piece:
        sign = self._peek()
        if sign in _BRACKETS or sign in ("|", "‖", "{"):
            return self._read_group(sign)
        if sign == "√":
            self.position += 1
            radicand = self._read_atom()
            return Piece(f"<msqrt>{radicand.inside or radicand.markup}</msqrt>")
        match = _TOKEN.match(self.text, self.position)
        if match is None:  # at the end of the text
            return Piece("")
        self.position = match.end()
        if (words := match["text"]) is not None:
            return Piece(f"<mtext>\u00a0{escape(words)}\u00a0</mtext>", "text")
        if match["number"]:
            return Piece(f"<mn>{match[0]}</mn>")
        if match["word"]:
            return self._read_word(match)
        if sign in _OPERATORS:
            printed_sign = "−" if sign == "-" else sign
            kind: Kind = "relation" if sign in _RELATIONS else "operator"
            return Piece(f"<mo>{escape(printed_sign)}</mo>", kind, is_sign=printed_sign in "+−")
        if sign in _LARGE_OPERATORS:
            return Piece(
                f"<mo>{_LARGE_OPERATORS[sign]}</mo>", "word", has_index_below=sign in _INDEXED_BELOW
            )
        accent = self._read_accent()
        upright = ' mathvariant="normal"' if sign in "ΔΦΨΛΩ∞" else ""
        return Piece(f"<mi{upright}>{escape(sign + accent)}</mi>")

    def _read_accent(self) -> str:
        accent = re.compile("[\u0300-\u036f]*").match(self.text, self.position)
        self.position += len(accent[0]) if accent else 0
        return accent[0] if accent else ""

    def _read_word(self, match: re.Match[str]) -> Piece:
        """Read a word of `_WORDS`, or the first letter of any other word, with its accent."""
        word = match["word"]
        if word in _WORDS:
            self.position = match.start() + len(word)
            markup = f'<mi mathvariant="normal">{word}</mi>'
            return Piece(markup, "word", has_index_below=word in _INDEXED_BELOW)
        self.position = match.start() + 1
        return Piece(f"<mi>{word[0]}{self._read_accent()}</mi>")

    def _read_group(self, sign: str) -> Piece:
        self.position += 1
        close = {**_BRACKETS, "{": "}"}.get(sign, sign)
        pieces = self.read_pieces(close)
        inside = side_by_side(pieces)
        is_fraction = len(pieces) == 1 and pieces[0].markup.startswith("<mfrac>")
        # Brackets around a single fraction are superfluous, unless a script follows them.
        if sign == "{" or (is_fraction and self._peek() not in "^_!'′"):
            return Piece(inside, inside=inside)
        fence = '<mo stretchy="false" form="{}">{}</mo>'
        is_tall = "<mfrac>" in inside or "<munder" in inside
        if is_tall and sign in _BRACKETS:
            fence = '<mo form="{}">{}</mo>'
        markup = f"{fence.format('prefix', sign)}{inside}{fence.format('postfix', close)}"
        return Piece(f"<mrow>{markup}</mrow>", inside=None if sign in "|‖" else inside)

    # -- scripts and fractions --------------------------------------------------------------------

    def _read_scripts(self, atom: Piece) -> Piece:
        """Return the atom with the indices, powers, primes and factorial signs that follow it."""
        lower = upper = suffix = ""
        while self.position < len(self.text):
            sign = self._peek()
            if sign == "_" and not lower:
                lower = self._read_script()
            elif sign == "^" and not upper:
                upper = self._read_script()
            elif sign in _SUPERSCRIPT and not upper:
                upper = self._read_run(_SUPERSCRIPT, _SUPERSCRIPT_DIGITS)
            elif sign in _SUBSCRIPT and not lower:
                lower = self._read_run(_SUBSCRIPT, _SUBSCRIPT_DIGITS)
            elif sign in "'′":
                suffix += '<mtext class="prime">′</mtext>'
                self.position += 1
            elif sign == "!":
                suffix += '<mo form="postfix">!</mo>'
                self.position += 1
            else:
                break
        if not (lower or upper or suffix):
            return atom
        return Piece(
            attach_scripts(atom.markup + suffix, lower, upper, below=atom.has_index_below),
            atom.kind,
        )

    def _read_run(self, signs: str, table: dict[int, int]) -> str:
        start = self.position
        while self._peek() and self._peek() in signs:
            self.position += 1
        return self._set_inner(self.text[start : self.position].translate(table))

    def _read_script(self) -> str:
        """Read the script after `_` or `^`: a group, set without brackets, a number or a word."""
        self.position += 1
        if self._peek() in ("(", "{"):
            self.script_depth += 1
            group = self._read_group(self._peek())
            self.script_depth -= 1
            return group.inside or ""
        match = _SCRIPT.match(self.text, self.position)
        if match is None:
            return self._read_atom().markup
        self.position = match.end()
        return self._set_inner(match[0])

    def _set_inner(self, text: str) -> str:
        reader = _FormulaReader(text)
        reader.script_depth = self.script_depth + 1
        return side_by_side(reader.read_pieces(""))

    def _read_product(self, end: str) -> list[Piece]:
        """Read the factors of a denominator up to the next space, such as n!, (η + 1)!, dt."""
        self._skip_spaces()
        pieces = [self._read_scripts(self._read_atom())]
        while self._peek() not in ("", " ", "/", "|", "‖") and not self._is_end(end):
            if self._peek() in _OPERATORS:
                break
            pieces.append(self._read_scripts(self._read_atom()))
        return pieces

    def _set_fraction(self, numerator: list[Piece], denominator: list[Piece]) -> Piece:
        is_apart = numerator[0].is_apart
        if self.script_depth:  # a stacked fraction would be too small to read
            slash = '<mo lspace="0" rspace="0">/</mo>'
            return Piece(
                f"<mrow>{side_by_side(numerator)}{slash}{side_by_side(denominator)}</mrow>",
                is_apart=is_apart,
            )
        parts = "".join(as_element(strip_brackets(pieces)) for pieces in (numerator, denominator))
        return Piece(f"<mfrac>{parts}</mfrac>", is_apart=is_apart)
