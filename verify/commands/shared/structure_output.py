"""Output of what a step keeps, as JSON and as lines."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.output import cut, pick, print_line

if TYPE_CHECKING:
    from verify.integrators.results import KeptStructure
    from verify.proof.structures.structure_order import StructureProof


def structure_json(proof: "StructureProof | KeptStructure") -> dict[str, Any]:
    """Return the keys of the proof on one structure."""
    return {
        "structure": proof.structure.name,
        "label": proof.structure.label,
        "defect": proof.structure.defect_formula,
        **pick(proof, "verdict", "reason", "order", "claimed"),
        "leading": proof.leading or None,
        "component": proof.component or None,
        **pick(proof, "telescopes", "potential"),
        "domain": proof.domain.texts,
    }


def print_structures(proofs: "Sequence[StructureProof | KeptStructure]") -> None:
    """Print each structure with its verdict, the leading term of its defect, and its domain."""
    for proof in proofs:
        click.echo(f"  {proof.structure.label}")
        print_line(f"  {str(proof.verdict).lower()}", str(proof.reason))
        if proof.order is not None and proof.leading:
            component = f" {proof.component}" if proof.component else ""
            term = f"({cut(proof.leading)})·h^{proof.order}{component}"
            print_line("  begins", term)
            if proof.telescopes:
                print_line("  G", f"{cut(proof.potential or '')}, the leading term is X·G")
        if proof.domain:
            print_line("  where", str(proof.domain.prose))
