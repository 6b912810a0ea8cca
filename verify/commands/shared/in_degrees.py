"""How a proof in n degrees of freedom is printed, and what its JSON has."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import picked
from verify.commands.shared.output import cut, print_head

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.proof.symplectic.proof import SymplecticProof


def symplectic_json(
    exact: "Hamiltonian", scheme: str, proof: "SymplecticProof", seconds: str
) -> dict[str, Any]:
    """The keys of a proof in the plane, of S in place of ΔJ, and what is known of det J beside."""
    from dataclasses import asdict

    from verify.arithmetic.exact import text

    return {
        **picked(proof, "verdict", "reason"),
        **exact.texts,
        "degrees": proof.degrees,
        "scheme": scheme,
        "order": proof.order,
        "leading": proof.leading_text,
        "delta_j": "0" if proof.area_preserving else None,
        **picked(proof, "symplectic", "area_preserving", "volume_order", "volume_leading"),
        **picked(proof, "convergence_order", "entry"),
        "witness": {name: text(value) for name, value in proof.witness.items()},
        "telescopes": proof.telescopes,
        "potential": proof.potential or None,
        "conditions": [asdict(condition) for condition in proof.conditions],
        "domain": proof.domain.texts,
        "special_values": [],
        "seconds": seconds,
    }


def print_symplectic(exact: "Hamiltonian", scheme: str, proof: "SymplecticProof") -> None:
    """The same for a reader."""
    from verify.arithmetic.exact import text

    print_head(exact, scheme, proof)
    if proof.order is not None:
        rest = f"h^{proof.order} + O(h^{proof.order + 1})"
        click.echo(f"  S        ({cut(proof.leading_text)})·{rest}")
    if proof.entry:
        at = ", ".join(f"{n} = {text(v)}" for n, v in proof.witness.items())
        click.echo(f"  witness  {at or 'any point'}: {proof.entry} has {proof.enclosure}")
    click.echo(f"  det J    {_of_volume(proof)}")
    if proof.telescopes is not None and not proof.symplectic:
        how = f"the Lie derivative of {cut(proof.potential)}" if proof.telescopes else "no"
        click.echo(f"  telescopes  {how}")
    for condition in proof.conditions:
        click.echo(f"  as       {condition.name}")
    if proof.domain:
        click.echo(f"  where    {proof.domain.prose}")
    order = proof.convergence_order
    known = "in all powers of h that were looked at" if order is None else f"up to h^{order}"
    click.echo(f"  the map  agrees with the exact flow {known}")


def _of_volume(proof: "SymplecticProof") -> str:
    if proof.area_preserving:
        return "≡ 1" + ("" if proof.symplectic else ", and yet the map is not symplectic")
    if proof.volume_order is not None:
        order = proof.volume_order
        return f"1 + ({cut(proof.volume_leading)})·h^{order} + O(h^{order + 1})"
    return "whether it is 1 is not decided"
