"""A file for Rocq: its statement in words, the theory it uses, its theorems and proofs."""

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

_LONGEST_FORMULA = 2000  # characters; longer formulas are cut in the introduction
_WIDTH = 88
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_INCLUDE = re.compile(r'{% include "(\w+)\.jinja" %}')
_STATED_NAME = re.compile(r"^(?:Lemma|Theorem) ([\w']+)", re.MULTILINE)
_THEOREM_NAME = re.compile(r"^Theorem (\w+)", re.MULTILINE)
_CLAIMS_HEADING, _REALS_HEADING = "(** * What is proved", "(** * Over the real numbers"
_TEMPLATES = Path(__file__).parent / "templates"


@dataclass(frozen=True)
class Export:
    """The parts of an exported file: theory, definitions, theorems and proofs.

    `needs`: the files of the theory. `template`, `values`: the template of definitions, theorems
    and proofs, and its variables. `of_rings`: True if there are theorems that hold in any ring and
    assume nothing. `shows_nonzero`: True if a theorem states that L is not 0, or there is no L.
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
    # The body is rendered first, as the theory is reduced to the parts that it needs.
    body = body_of(export)
    theory = format_modules(export.needs, body) if stands_alone else import_line(export.needs)
    assumptions = _print_assumptions(body[body.index(_CLAIMS_HEADING) :], of_rings=export.of_rings)
    return lines(f"{head}{theory}\n{body.rstrip()}\n\n(** * What they assume *)\n\n{assumptions}")


def body_of(export: Export) -> str:
    """Render the definitions, the theorems and their proofs."""
    return _environment().get_template(f"{export.template}.jinja").render(export.values)


def theorems_of(body: str) -> tuple[str, ...]:
    """Return the names of the theorems, in order."""
    return tuple(_THEOREM_NAME.findall(body))


def _print_assumptions(claimed: str, *, of_rings: bool) -> str:
    """Format the commands by which Rocq prints the theorems' assumptions.

    Each command takes Rocq about a second: so there is one for all theorems of rings, and one for
    all theorems over the real numbers.
    """
    rings, _, reals = claimed.partition(_REALS_HEADING) if of_rings else ("", "", claimed)
    kinds = {"theorems_of_rings": rings, "theorems_over_the_reals": reals}
    return "\n".join(
        _print_command(name, _STATED_NAME.findall(text)) for name, text in kinds.items() if text
    )


def _print_command(name: str, theorems: Sequence[str]) -> str:
    if len(theorems) == 1:
        return f"Print Assumptions {theorems[0]}.\n"
    listed = ",\n  ".join(theorems)
    return f"Definition {name} := (\n  {listed}).\n\nPrint Assumptions {name}.\n"


@cache
def template_words(template: str) -> frozenset[str]:
    """Return the words of a template and its includes; no certificate's name may be one."""
    text = (_TEMPLATES / f"{template}.jinja").read_text(encoding="utf-8")
    included = (template_words(name) for name in _INCLUDE.findall(text))
    return frozenset(_WORD.findall(text)).union(*included)


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(_TEMPLATES, encoding="utf-8"),
        autoescape=False,  # noqa: S701 - no HTML: the values are checked numbers and names
        # A missing variable must be an error, and not an empty text within a proof.
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
        f"{name} = {_comment(text if len(text) <= _LONGEST_FORMULA else _cut(text))}"
        for name, text in formulas.items()
        if text
    ] + [f"where {_comment(text)}" for text in facts.domain]


def _cut(text: str) -> str:
    return f"{text[:_LONGEST_FORMULA].rsplit(' ', 1)[0]} ..."


def _comment(text: str) -> str:
    """Escape all that begins or ends a comment or a string in Rocq."""
    return text.replace('"', "'").replace("(*", "( *").replace("*)", "* )")
