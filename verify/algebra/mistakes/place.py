"""Places in a text, as a person counts lines and columns."""

import re


def place(text: str, index: int) -> str:
    """Format the column, from 1, of a character, and its line where there are several."""
    before = text[:index]
    column = f"column {index - before.rfind(chr(10))}"
    return f"line {before.count(chr(10)) + 1}, {column}" if "\n" in text.strip() else column


def index_of(text: str, offset: int) -> int:
    """Convert an offset in the line that Python reads to an index in the text.

    In that line ^ is written **, and each run of blanks is one space.
    """
    position = last = 0
    for match in re.finditer(r"\S+|\s+", text.strip()):
        if match[0].isspace():
            position += 1
            continue
        for last, c in enumerate(match[0], match.start()):
            position += 2 if c == "^" else 1
            if position > offset:
                return last + len(text) - len(text.lstrip())
    return last + len(text) - len(text.lstrip())
