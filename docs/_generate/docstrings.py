"""Docstrings as reStructuredText: ours are sentences with code in backticks, and code indented.

In reStructuredText `|Λ|` would be a substitution, `**` strong, and what is indented a quotation.
"""

import re
from collections.abc import Iterator, Sequence

_CODE = re.compile(r"`+([^`]+)`+")
_INDENT = "    "


def as_rst(lines: Sequence[str]) -> list[str]:
    """The lines of a docstring, whose first is not indented, as autodoc wants them."""
    return [line for block in _blocks(lines) for line in [*_shown(block), ""]]


def _blocks(lines: Sequence[str]) -> Iterator[list[str]]:
    """Paragraphs, and what is indented or a session, each as one; blank lines left out."""
    block: list[str] = []
    for line in lines:
        if block and (not line.strip() or _is_code(line) != _is_code(block[0])):
            yield block
            block = []
        if line.strip():
            block.append(line)
    if block:
        yield block


def _is_code(line: str) -> bool:
    return line.startswith((_INDENT, ">>>", "..."))


def _shown(block: list[str]) -> list[str]:
    if block[0].startswith(">>>"):
        return block
    if _is_code(block[0]):
        return ["::", "", *block]
    return [_prose(line) for line in _whole_code(block)]


def _whole_code(block: list[str]) -> list[str]:
    """One line, so that no code is broken by the end of one."""
    return [" ".join(line.strip() for line in block)]


def _prose(line: str) -> str:
    """Code as literals, and everything else as it stands."""
    parts = _CODE.split(line)
    escaped = (re.sub(r"([\\*_|`])", r"\\\1", part) for part in parts[::2])
    coded = (f"``{part}``" for part in parts[1::2])
    return "".join(_joined([*escaped], [*coded]))


def _joined(texts: list[str], codes: list[str]) -> Iterator[str]:
    """With an escaped blank where a literal would touch a letter, which ends no literal."""
    for text, code in zip(texts, [*codes, ""], strict=True):
        yield text + ("\\ " if text[-1:].isalnum() and code else "")
        yield code and f"{code}\\ "
