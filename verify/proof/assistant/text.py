"""A file for Rocq: what it proves in words, the theory it stands on, and the proofs."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from textwrap import wrap
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from verify.proof.assistant.formulas import lines
from verify.proof.assistant.shipped import as_modules, imported
from verify.proof.certificates.established import Established

_LONGEST = 2000  # characters of a formula in the words
_WIDTH = 88
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_INCLUDED = re.compile(r'{% include "(\w+)\.jinja" %}')
_STATED = re.compile(r"^(?:Lemma|Theorem) ([\w']+)", re.MULTILINE)
_THEOREM = re.compile(r"^Theorem (\w+)", re.MULTILINE)
_CLAIMED, _OVER_THE_REALS = "(** * What is proved", "(** * Over the real numbers"
_TEMPLATES = Path(__file__).parent / "templates"


@dataclass(frozen=True)
class Export:
    """`needs`: files of the theory; `template`, with `values`: definitions, theorems, proofs.

    `of_rings`: whether the theorems are of any ring, and assume nothing. `shows_nonzero`: whether
    one of them is that L is not 0, where there is an L.
    """

    needs: Sequence[str]
    template: str
    values: dict[str, Any]
    of_rings: bool = False
    shows_nonzero: bool = True


def written(export: Export, of: Established, *, stands_alone: bool) -> str:
    """The whole file."""
    said = [line for text in _said(of) for line in wrap(text, _WIDTH, subsequent_indent="  ")]
    statement = "\n    ".join(wrap(_comment(of.statement), _WIDTH))
    words = {
        "statement": statement,
        "said": said,
        "alone": stands_alone,
        "shows_nonzero": export.shows_nonzero,
    }
    head = _environment().get_template("head.jinja").render(words)
    body = body_of(export)
    theory = as_modules(export.needs, by=body) if stands_alone else imported(export.needs)
    asked = _asked(body[body.index(_CLAIMED) :], of_rings=export.of_rings)
    return lines(f"{head}{theory}\n{body.rstrip()}\n\n(** * What they assume *)\n\n{asked}")


def body_of(export: Export) -> str:
    """The definitions, the theorems and their proofs."""
    return _environment().get_template(f"{export.template}.jinja").render(export.values)


def theorems_of(body: str) -> tuple[str, ...]:
    """The names of the theorems, in order."""
    return tuple(_THEOREM.findall(body))


def _asked(claimed: str, *, of_rings: bool) -> str:
    """By which Rocq prints what the theorems assume: of rings, and over the real numbers.

    For each theorem it would go through the library anew, for about a second: it is asked of all
    of a kind together.
    """
    rings, _, reals = claimed.partition(_OVER_THE_REALS) if of_rings else ("", "", claimed)
    kinds = {"theorems_of_rings": rings, "theorems_over_the_reals": reals}
    return "\n".join(_asked_of(name, _STATED.findall(text)) for name, text in kinds.items() if text)


def _asked_of(name: str, theorems: Sequence[str]) -> str:
    if len(theorems) == 1:
        return f"Print Assumptions {theorems[0]}.\n"
    listed = ",\n  ".join(theorems)
    return f"Definition {name} := (\n  {listed}).\n\nPrint Assumptions {name}.\n"


@cache
def template_words(template: str) -> frozenset[str]:
    """The words of a template and of those it includes, which no name of a certificate may hide."""
    text = (_TEMPLATES / f"{template}.jinja").read_text(encoding="utf-8")
    included = (template_words(name) for name in _INCLUDED.findall(text))
    return frozenset(_WORD.findall(text)).union(*included)


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(_TEMPLATES, encoding="utf-8"),
        autoescape=False,  # noqa: S701 - no page: what is set is numbers and names that were checked
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def _said(of: Established) -> list[str]:
    told = {"H": of.hamiltonian, "L": of.leading, "G": of.potential, "map": of.scheme}
    return [
        f"{name} = {_comment(text if len(text) <= _LONGEST else _cut(text))}"
        for name, text in told.items()
        if text
    ] + [f"where {_comment(text)}" for text in of.domain]


def _cut(text: str) -> str:
    return f"{text[:_LONGEST].rsplit(' ', 1)[0]} ..."


def _comment(text: str) -> str:
    """The text with nothing in it that ends or begins a comment or a string of Rocq."""
    return text.replace('"', "'").replace("(*", "( *").replace("*)", "* )")
