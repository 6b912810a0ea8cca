"""Markdown as parts of pages are written in it."""

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; a column that is empty in every row is left out."""
    body = [[cell(each) for each in row] for row in rows]
    kept = [k for k in range(len(head)) if any(row[k] for row in body)]
    lines = [
        [head[k] for k in kept],
        ["---"] * len(kept),
        *([row[k] for k in kept] for row in body),
    ]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def cell(text: str) -> str:
    """A text on one line that ends no cell."""
    return " ".join(text.split()).replace("|", "\\|")


def code(text: str) -> str:
    """A text as code; empty where it is."""
    return f"`{text}`" if text else ""


def codes(texts: Iterable[str]) -> str:
    """Several, one after another."""
    return " ".join(map(code, texts))


def prose(text: str) -> str:
    """A docstring's sentences, in which `*` and `_` are themselves; code stands in backticks."""
    parts = text.split("`")
    plain = (
        part.replace("*", "\\*").replace("_", "\\_").replace("<", "&lt;") for part in parts[::2]
    )
    coded = (f"`{part}`" for part in parts[1::2])
    return "".join(x for pair in zip(plain, [*coded, ""], strict=False) for x in pair)
