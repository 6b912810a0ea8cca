"""A proof as numbered steps, a sentence each, with its long formulas on lines of their own."""

import re
from collections.abc import Iterator

from markupsafe import Markup

from verify.pages.text.notation import notation
from verify.pages.text.prose import prose
from verify.prose import Formula, Prose

_END = "∎"  # of a proof
_FEW = 3  # sentences that are one paragraph as well
_DISPLAYED = 34  # characters of a formula that is not set within a line
# A full stop after a word, and what may begin a sentence; "Eq. 9" is within one.
_STOP = re.compile(r"(?<=[^\s.])(?<!Eq)(?<!Eqs)(?<!Fig)(?<!cf)\.\s+(?=[A-ZΔΛΦΣ(∎]|$)")


def steps(text: str) -> Markup:
    """An ordered list of the sentences; a paragraph, where there are few."""
    sentences = list(_sentences(text if isinstance(text, Prose) else Prose(text)))
    if len(sentences) <= _FEW:
        return Markup("<p>{}</p>").format(prose(text))
    items = (Markup("<li>{}</li>").format(_set(each)) for each in sentences)
    return Markup('<ol class="steps">{}</ol>').format(Markup("\n").join(items))


def _sentences(text: Prose) -> Iterator[Prose]:
    """With their full stops; the sign of a proof's end belongs to the last."""
    parts: list[str] = []
    for part in text.parts:
        if type(part) is not str:
            parts.append(part)
            continue
        begun, *others = _STOP.split(part)
        if others and others[-1].strip() == _END:
            others[-2:] = [f"{others[-2]}. {_END}"] if len(others) > 1 else []
            begun = begun if others else f"{begun}. {_END}"
        for following in others:
            yield Prose(*parts, f"{begun}.")
            parts, begun = [], following
        parts.append(begun)
    if str(Prose(*parts)).strip():
        yield Prose(*parts)


def _set(sentence: Prose) -> Markup:
    made = []
    for part in sentence.parts:
        if isinstance(part, Formula) and len(part) >= _DISPLAYED and "*" not in part:
            made.append(Markup('<span class="displayed">{}</span>').format(notation(part)))
        else:
            made.append(prose(Prose(part)))
    return Markup("").join(made)
