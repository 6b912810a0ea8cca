"""Messages about characters that no formula has: their names, and what to write."""

import keyword
import re
import unicodedata

from verify.algebra.mistakes.place import place

_INSTEAD = {
    **dict.fromkeys("·×⋅∗•∙", "*"), **dict.fromkeys("÷∕⁄", "/"), **dict.fromkeys("−–—‐‑", "-"),
    "√": "sqrt(…)", "ħ": "hbar", "ℏ": "hbar", "°": "*pi/180", "ⅇ": "exp(1)",
}  # fmt: skip
_LEFT_OUT = frozenset("“”„‘’«»‹›′″")
_GREEK = re.compile(r"GREEK (?:SMALL |CAPITAL )?(?:LETTER )?(?:FINAL |LUNATE )?(\w+)")
_POWER = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻]+")


def strange_character(text: str) -> str:
    """Describe the first character that is outside ASCII, else the first unprintable one."""
    foreign = next((k for k, c in enumerate(text) if not c.isascii()), None)
    if foreign is None:
        unseen = (k for k, c in enumerate(text) if not (c.isprintable() or c.isspace()))
        index = next(unseen, 0)
        where = f"U+{ord(text[index]):04X} at {place(text, index)}"
        return f"is not a formula: {where} is not allowed; leave it out"
    c = text[foreign]
    name = unicodedata.name(c, "without a name").lower()
    text_of_character = c if c.isprintable() and c.strip() else f"U+{ord(c):04X}"
    instead = _instead(c, text[foreign:])
    return f"at {place(text, foreign)}: {text_of_character} ({name}) is outside ASCII; {instead}"


def _instead(c: str, rest: str) -> str:
    # Compatibility normalization maps look-alikes, such as full-width letters, to plain ones.
    plain = unicodedata.normalize("NFKC", c)
    if c in _LEFT_OUT:
        return "leave it out"
    if c in _INSTEAD:
        return f"write {_INSTEAD[c]}"
    if power := _POWER.match(rest):
        return f"write **{unicodedata.normalize('NFKC', power[0]).replace('−', '-')}"
    if greek := _GREEK.match(unicodedata.name(plain[:1], "")):
        letter = greek[1].lower().replace("lamda", "lambda")
        letter = letter if plain.islower() else letter.capitalize()
        return f"write {letter}_" if keyword.iskeyword(letter) else f"write {letter}"
    if not c.isprintable() or not plain.strip():
        return "write a space, or leave it out"
    if plain.replace("⁄", "/").isascii():  # ½, ₁, full-width letters
        return f"write ({plain.replace('⁄', '/')})" if len(plain) > 1 else f"write {plain}"
    return "allowed: + - * / **, numbers, and names of ASCII letters, digits and _"
