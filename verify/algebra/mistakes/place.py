"""Where in a text something stands, for whoever looks for it there."""

import re


def place(text: str, index: int) -> str:
    """The column, from 1, of the character of that index; its line too where there are several."""
    before = text[:index]
    column = f"column {index - before.rfind(chr(10))}"
    return f"line {before.count(chr(10)) + 1}, {column}" if "\n" in text.strip() else column


def index_of(text: str, offset: int) -> int:
    """The index in the text of what stands at that offset in its one line, which Python reads.

    There ^ is **, and what is blank is one space.
    """
    at = last = 0
    for match in re.finditer(r"\S+|\s+", text.strip()):
        if match[0].isspace():
            at += 1
            continue
        for last, c in enumerate(match[0], match.start()):
            at += 2 if c == "^" else 1
            if at > offset:
                return last + len(text) - len(text.lstrip())
    return last + len(text) - len(text.lstrip())
