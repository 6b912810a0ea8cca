"""A formula on a line of its own, in the notation of prose → MathML Core, by a small reader.

    |Λ| ≤ (1 + ε)^N − 1 ≤ e^(Nε) − 1        Σ_{n=0}^{η} h^n/n! X^n z        "where" D ≠ 0

Letters side by side are a product, but for the words in `_WORDS`. The sides of a `/` reach to the
next space, or are in brackets, which are not shown, as those of what `_` and `^` bind. A long
formula is set in several rows. What is not recognised is set as it is.
"""

import re

from markupsafe import Markup, escape

from verify.functions import by_name
from verify.pages.text.pieces import (
    Kind,
    Piece,
    bound,
    in_rows,
    one,
    side_by_side,
    taken_from,
    unbracketed,
)

_WORDS = {
    "det", "div", "tr", "adj", "Hess", "log", "max", "min", "lim", "MSE", "area", "const", "end",
    *(f.shown for f in by_name().values()),
}  # fmt: skip
_BELOW = {"Σ", "Π", "max", "min", "lim"}  # what has its index below it
_LARGE = {"Σ": "∑", "Π": "∏", "∫": "∫", "∂": "∂", "∇": "∇"}
_RELATIONS = set("=≠<>≤≥≡→↦∈≈⇒⇔")
_OPERATORS = set("+−-·×∘∧,;:…±∪∩") | _RELATIONS
_BRACKETS = {"(": ")", "[": "]", "⟨": "⟩"}
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺ⁿᵀᵏ", "0123456789−+nTk")
_LOWERED = str.maketrans("₀₁₂₃₄₅₆₇₈₉ₖₙₜ", "0123456789knt")
_SUPERSCRIPT, _SUBSCRIPT = ("".join(map(chr, table)) for table in (_RAISED, _LOWERED))
_TOKEN = re.compile(
    rf'"(?P<text>[^"]*)"|(?P<number>[0-9]+(?:\.[0-9]+)?)|(?P<word>[A-Za-z]+)[\u0300-\u036f]?'
    rf"|(?P<raised>[{_SUPERSCRIPT}]+)|(?P<lowered>[{_SUBSCRIPT}]+)|(?P<sign>.)",
    re.DOTALL,
)
_SCRIPT = re.compile(r"[−-]?(?:[0-9]+|[A-Za-z]+|[\u0370-\u03ff])")


def displayed(text: str, end: str = "") -> Markup:
    """The formula as a block of its own, with the stop or comma that ends it."""
    reader = _Reader(" ".join(text.split()))
    rows = in_rows(reader.items(""))
    if end:
        rows[-1].append(Piece(f"<mtext>{escape(end)}</mtext>"))
    if len(rows) == 1:
        content = side_by_side(rows[0])
    else:
        lines = "".join(f'<mtr><mtd class="l">{side_by_side(row)}</mtd></mtr>' for row in rows)
        content = f'<mtable displaystyle="true">{lines}</mtable>'
    return Markup(f'<math display="block">{content}</math>')  # noqa: S704 - leaves are escaped


class _Reader:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.small = 0  # scripts around

    def items(self, end: str) -> list[Piece]:
        """What stands up to the sign `end`, which is passed over."""
        found: list[Piece] = []
        while self.at < len(self.text):
            apart = self._space()
            if self.at >= len(self.text) or self._ends(end):
                break
            if self._next() == "/" and found:
                self.at += 1
                above = taken_from(found)
                found.append(self._fraction(above, self._product(end)))
                continue
            item = self._scripted(self._atom())
            item.apart = apart
            found.append(item)
        self.at += bool(end)
        return found

    def _next(self) -> str:
        return self.text[self.at : self.at + 1]

    def _space(self) -> bool:
        begun = self.at
        while self._next() == " ":
            self.at += 1
        return self.at > begun

    def _ends(self, end: str) -> bool:
        if end in ("|", "‖") and self._next() == end:
            before, after = self.text[self.at - 1], self.text[self.at + 1 : self.at + 2]
            return before not in " (," or after in ("", " ", ")", ",")
        return bool(end) and self._next() == end

    # -- what stands alone ------------------------------------------------------------------------

    def _atom(self) -> Piece:
        sign = self._next()
        if sign in _BRACKETS or sign in ("|", "‖", "{"):
            return self._group(sign)
        if sign == "√":
            self.at += 1
            under = self._atom()
            return Piece(f"<msqrt>{under.inside or under.markup}</msqrt>")
        match = _TOKEN.match(self.text, self.at)
        if match is None:  # at the end
            return Piece("")
        self.at = match.end()
        if (said := match["text"]) is not None:
            return Piece(f"<mtext>\u00a0{escape(said)}\u00a0</mtext>", "text")
        if match["number"]:
            return Piece(f"<mn>{match[0]}</mn>")
        if match["word"]:
            return self._word(match)
        if sign in _OPERATORS:
            shown = "−" if sign == "-" else sign
            kind: Kind = "relation" if sign in _RELATIONS else "operator"
            return Piece(f"<mo>{escape(shown)}</mo>", kind, sign=shown in "+−")
        if sign in _LARGE:
            return Piece(f"<mo>{_LARGE[sign]}</mo>", "word", below=sign in _BELOW)
        accent = self._accent()
        upright = ' mathvariant="normal"' if sign in "ΔΦΨΛΩ∞" else ""
        return Piece(f"<mi{upright}>{escape(sign + accent)}</mi>")

    def _accent(self) -> str:
        accent = re.compile("[\u0300-\u036f]*").match(self.text, self.at)
        self.at += len(accent[0]) if accent else 0
        return accent[0] if accent else ""

    def _word(self, match: re.Match[str]) -> Piece:
        """A word of `_WORDS`; of another the first letter alone, with its accent."""
        word = match["word"]
        if word in _WORDS:
            self.at = match.start() + len(word)
            markup = f'<mi mathvariant="normal">{word}</mi>'
            return Piece(markup, "word", below=word in _BELOW)
        self.at = match.start() + 1
        return Piece(f"<mi>{word[0]}{self._accent()}</mi>")

    def _group(self, sign: str) -> Piece:
        self.at += 1
        close = {**_BRACKETS, "{": "}"}.get(sign, sign)
        items = self.items(close)
        inside = side_by_side(items)
        alone = len(items) == 1 and items[0].markup.startswith("<mfrac>")
        if sign == "{" or (alone and self._next() not in "^_!'′"):
            return Piece(inside, inside=inside)
        fence = '<mo stretchy="false" form="{}">{}</mo>'
        tall = "<mfrac>" in inside or "<munder" in inside
        if tall and sign in _BRACKETS:
            fence = '<mo form="{}">{}</mo>'
        markup = f"{fence.format('prefix', sign)}{inside}{fence.format('postfix', close)}"
        return Piece(f"<mrow>{markup}</mrow>", inside=None if sign in "|‖" else inside)

    # -- what is bound to it ----------------------------------------------------------------------

    def _scripted(self, item: Piece) -> Piece:
        lower = upper = after = ""
        while self.at < len(self.text):
            sign = self._next()
            if sign == "_" and not lower:
                lower = self._script()
            elif sign == "^" and not upper:
                upper = self._script()
            elif sign in _SUPERSCRIPT and not upper:
                upper = self._run(_SUPERSCRIPT, _RAISED)
            elif sign in _SUBSCRIPT and not lower:
                lower = self._run(_SUBSCRIPT, _LOWERED)
            elif sign in "'′":
                after += '<mtext class="prime">′</mtext>'
                self.at += 1
            elif sign == "!":
                after += '<mo form="postfix">!</mo>'
                self.at += 1
            else:
                break
        if not (lower or upper or after):
            return item
        return Piece(bound(item.markup + after, lower, upper, below=item.below), item.kind)

    def _run(self, signs: str, table: dict[int, int]) -> str:
        begun = self.at
        while self._next() and self._next() in signs:
            self.at += 1
        return self._inner(self.text[begun : self.at].translate(table))

    def _script(self) -> str:
        """What `_` or `^` binds: a group without its brackets, a number, a word, a letter."""
        self.at += 1
        if self._next() in ("(", "{"):
            self.small += 1
            group = self._group(self._next())
            self.small -= 1
            return group.inside or ""
        match = _SCRIPT.match(self.text, self.at)
        if match is None:
            return self._atom().markup
        self.at = match.end()
        return self._inner(match[0])

    def _inner(self, text: str) -> str:
        reader = _Reader(text)
        reader.small = self.small + 1
        return side_by_side(reader.items(""))

    def _product(self, end: str) -> list[Piece]:
        """What stands there without a space between: n!, (η + 1)!, dt."""
        self._space()
        found = [self._scripted(self._atom())]
        while self._next() not in ("", " ", "/", "|", "‖") and not self._ends(end):
            if self._next() in _OPERATORS:
                break
            found.append(self._scripted(self._atom()))
        return found

    def _fraction(self, above: list[Piece], below: list[Piece]) -> Piece:
        apart = above[0].apart
        if self.small:  # too small for one above the other
            slash = '<mo lspace="0" rspace="0">/</mo>'
            return Piece(
                f"<mrow>{side_by_side(above)}{slash}{side_by_side(below)}</mrow>", apart=apart
            )
        parts = "".join(one(unbracketed(each)) for each in (above, below))
        return Piece(f"<mfrac>{parts}</mfrac>", apart=apart)
