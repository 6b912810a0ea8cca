"""Docstrings as reStructuredText: ours are sentences with code in backticks, and code indented.

In reStructuredText `|Λ|` would be a substitution, `**` strong, and what is indented a quotation.
Under a heading with dashes below it, each `name: text` is an entry.
"""

import re
from collections.abc import Iterator, Sequence

_CODE = re.compile(r"`+([^`]+)`+")
_ENTRY = re.compile(r"(?P<names>\w+(?:, \w+)*): (?P<text>.*)")
_INDENT = "    "


def as_rst(lines: Sequence[str]) -> list[str]:
    """The lines of a docstring, whose first is not indented, as autodoc wants them."""
    return [line for block in _blocks(lines) for line in [*_shown(block), ""]]


def _blocks(lines: Sequence[str]) -> Iterator[list[str]]:
    """What stands between blank lines."""
    block: list[str] = []
    for line in [*lines, ""]:
        if line.strip():
            block.append(line)
        elif block:
            yield block
            block = []


def _shown(block: list[str]) -> list[str]:
    if block[0].startswith(">>>"):
        return block
    if block[0].startswith(_INDENT):
        return ["::", "", *block]
    if len(block) > 1 and set(block[1]) == {"-"}:
        return [f"**{block[0]}**", "", *_entries(block[2:])]
    return [_prose(_one_line(block))]


def _one_line(block: Sequence[str]) -> str:
    """So that no code is broken by the end of a line."""
    return " ".join(line.strip() for line in block)


def _entries(block: Sequence[str]) -> Iterator[str]:
    """A definition list of its entries; a paragraph where it has none."""
    groups: list[list[str]] = []
    for line in block:
        if _ENTRY.match(line) or not groups:
            groups.append([])
        groups[-1].append(line)
    for group in groups:
        text = _one_line(group)
        entry = _ENTRY.match(text)
        if entry:
            yield ", ".join(f"``{name}``" for name in entry["names"].split(", "))
            yield _INDENT + _prose(entry["text"])
        else:
            yield _prose(text)


def _prose(line: str) -> str:
    """Code as literals, and everything else as it stands."""
    parts = _CODE.split(line)
    escaped = [re.sub(r"([\\*_|`])", r"\\\1", part) for part in parts[::2]]
    coded = [f"``{part}``" for part in parts[1::2]]
    return "".join(_joined(escaped, coded))


def _joined(texts: list[str], codes: list[str]) -> Iterator[str]:
    """With an escaped blank where a literal would touch a letter, which ends no literal."""
    for text, code in zip(texts, [*codes, ""], strict=True):
        yield text + ("\\ " if text[-1:].isalnum() and code else "")
        yield code and f"{code}\\ "
