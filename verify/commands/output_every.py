"""Proofs for every H, as JSON and on the terminal."""

import textwrap
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from verify.commands.output import cut

if TYPE_CHECKING:
    from verify.proof.every import EveryProof

_WIDTH = 88


def every_json(proof: "EveryProof", seconds: str) -> dict[str, Any]:
    return {
        "verdict": proof.verdict.value,
        "reason": proof.reason,
        "hamiltonian": proof.quantifier,
        "scheme": proof.scheme,
        "order": proof.order,
        "leading": proof.leading,
        "formula": proof.formula or None,
        "delta_j": "0" if proof.area_preserving else None,  # there is no closed form in the jets
        "area_preserving": proof.area_preserving,
        "convergence_order": proof.convergence_order,
        "telescopes": proof.telescopes,
        "potential": proof.potential,
        "why": proof.why,
        "checked": list(proof.checked),
        "conditions": [asdict(condition) for condition in proof.conditions],
        "seconds": seconds,
    }


def print_every(proof: "EveryProof") -> None:
    click.echo(f"{proof.verdict}: {proof.reason}")
    _line("H", proof.quantifier)
    _line("scheme", proof.scheme)
    if proof.order is not None:
        _line("leading", f"h^{proof.order} · ({cut(proof.formula or proof.leading)})")
        if proof.formula:
            _line("", f"= h^{proof.order} · ({cut(proof.leading)})")
    if proof.telescopes:
        _line("G", f"{cut(proof.potential or '')}, the leading coefficient is X·G")
    if proof.telescopes is not None:
        _line("telescopes", ("yes: " if proof.telescopes else "no: ") + cut(proof.why))
    _line("the map", f"agrees with the exact flow up to h^{proof.convergence_order}")
    for identity in proof.checked:
        _line("checked", identity)
    for condition in proof.conditions:
        found = "holds" if condition.holds else f"residue {condition.residue}"
        _line("condition", f"{condition.name}: {found}")


def _line(name: str, text: str) -> None:
    indent = " " * 13
    first = f"  {name:11}"
    click.echo(textwrap.fill(text, _WIDTH, initial_indent=first, subsequent_indent=indent))
