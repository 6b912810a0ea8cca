"""A file for Rocq: what it proves in words, the theory it stands on, and the proofs."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from textwrap import wrap
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from verify.proof.assistant.rocq_formulas import lines
from verify.proof.assistant.shipped_theory import format_modules, import_line
from verify.proof.certificates.established_statement import EstablishedStatement

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
    """The parts of an exported file: theory, definitions, theorems and proofs.

    `needs`: files of the theory; `template`, with `values`: definitions, theorems and proofs.
    `of_rings`: whether the theorems hold in any ring and assume nothing. `shows_nonzero`: whether
    one of them states that L is not 0, where there is an L.
    """

    needs: Sequence[str]
    template: str
    values: dict[str, Any]
    of_rings: bool = False
    shows_nonzero: bool = True


def render_file(export: Export, facts: EstablishedStatement, *, stands_alone: bool) -> str:
    """Render the whole file for Rocq."""
    fact_lines = [
        line
        for text in _formulas_in_words(facts)
        for line in wrap(text, _WIDTH, subsequent_indent="  ")
    ]
    statement = "\n    ".join(wrap(_comment(facts.statement), _WIDTH))
    words = {
        "statement": statement,
        "said": fact_lines,
        "alone": stands_alone,
        "shows_nonzero": export.shows_nonzero,
    }
    head = _environment().get_template("head.jinja").render(words)
    # The theory is reduced to what the body names, so the body is rendered first.
    body = body_of(export)
    theory = format_modules(export.needs, body) if stands_alone else import_line(export.needs)
    assumptions = _print_assumptions(body[body.index(_CLAIMED) :], of_rings=export.of_rings)
    return lines(f"{head}{theory}\n{body.rstrip()}\n\n(** * What they assume *)\n\n{assumptions}")


def body_of(export: Export) -> str:
    """Render the definitions, the theorems and their proofs."""
    return _environment().get_template(f"{export.template}.jinja").render(export.values)


def theorems_of(body: str) -> tuple[str, ...]:
    """Return the names of the theorems, in order."""
    return tuple(_THEOREM.findall(body))


def _print_assumptions(claimed: str, *, of_rings: bool) -> str:
    """Write the commands by which Rocq prints what the theorems assume, by kind.

    For each command Rocq goes through the library anew, for about a second: so one command stands
    for all theorems of rings, and one for those over the real numbers.
    """
    rings, _, reals = claimed.partition(_OVER_THE_REALS) if of_rings else ("", "", claimed)
    kinds = {"theorems_of_rings": rings, "theorems_over_the_reals": reals}
    return "\n".join(
        _print_command(name, _STATED.findall(text)) for name, text in kinds.items() if text
    )


def _print_command(name: str, theorems: Sequence[str]) -> str:
    if len(theorems) == 1:
        return f"Print Assumptions {theorems[0]}.\n"
    listed = ",\n  ".join(theorems)
    return f"Definition {name} := (\n  {listed}).\n\nPrint Assumptions {name}.\n"


@cache
def template_words(template: str) -> frozenset[str]:
    """Return the words of a template and its includes, which no certificate's name may hide."""
    text = (_TEMPLATES / f"{template}.jinja").read_text(encoding="utf-8")
    included = (template_words(name) for name in _INCLUDED.findall(text))
    return frozenset(_WORD.findall(text)).union(*included)


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(_TEMPLATES, encoding="utf-8"),
        autoescape=False,  # noqa: S701 - no page: what is set is numbers and names that were checked
        # A variable missing in a template must not become an empty text within a proof.
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def _formulas_in_words(facts: EstablishedStatement) -> list[str]:
    formulas = {
        "H": facts.hamiltonian,
        "L": facts.leading,
        "G": facts.potential,
        "map": facts.scheme,
    }
    return [
        f"{name} = {_comment(text if len(text) <= _LONGEST else _cut(text))}"
        for name, text in formulas.items()
        if text
    ] + [f"where {_comment(text)}" for text in facts.domain]


def _cut(text: str) -> str:
    return f"{text[:_LONGEST].rsplit(' ', 1)[0]} ..."


def _comment(text: str) -> str:
    """Escape everything in the text that ends or begins a comment or a string of Rocq."""
    return text.replace('"', "'").replace("(*", "( *").replace("*)", "* )")
