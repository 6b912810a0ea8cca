"""What a reader sees of a text in LaTeX, by a reader that shares nothing with what writes it."""

import re

# What LaTeX reads in a special way; all else that is ASCII stands for itself.
SPECIAL = r"#$%&_{}\^~"
SHOWN = {
    **{rf"\{c}": c for c in "#$%&_{}"}, r"\textbackslash{}": "\\", r"\textasciicircum{}": "^",
    r"\textasciitilde{}": "~", r"\`{}": "`", r"\ensuremath{<}": "<", r"\ensuremath{>}": ">",
    r"\ensuremath{|}": "|", r"\ensuremath{-}": "−", "{}": "", "``": "“", "''": "”",
    "---": "—", "--": "–",
}  # fmt: skip
_TOKEN = re.compile("|".join(map(re.escape, sorted(SHOWN, key=len, reverse=True))) + "|.", re.S)
_COMMAND = re.compile(r"\\([A-Za-z]+)")


def shown(latex: str) -> str:
    """The text of a piece of LaTeX; AssertionError if anything in it is read in a special way."""
    return "".join(map(_character, _TOKEN.findall(latex)))


def _character(token: str) -> str:
    assert token in SHOWN or token not in SPECIAL, f"{token!r} is read in a special way"
    return SHOWN.get(token, token)


def commands(latex: str) -> set[str]:
    """The names of its commands that are words."""
    return set(_COMMAND.findall(latex))
