"""How a proof in n degrees of freedom is printed, and what its JSON has."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import picked
from verify.commands.shared.output import (
    agreement,
    agreement_json,
    cut,
    line,
    order_json,
    print_checks,
)

if TYPE_CHECKING:
    from verify.proof.symplectic.proof import SymplecticProof
_LONG = 352  # characters of S, beyond which its formula stands for it


def symplectic_json(
    texts: Mapping[str, Any], scheme: str, proof: "SymplecticProof", seconds: str
) -> dict[str, Any]:
    """The keys of a proof in the plane, of S in place of ΔJ, and what is known of det J beside.

    `texts`: H and its parameters, or for which H it is.
    """
    from dataclasses import asdict

    from verify.arithmetic.exact import text

    return {
        **picked(proof, "verdict", "reason"),
        **texts,
        "degrees": proof.degrees,
        "scheme": scheme,
        **order_json(proof.order),
        "leading": proof.leading_text,
        "formula": proof.formula or None,
        "delta_j": "0" if proof.area_preserving else None,
        **picked(proof, "symplectic", "area_preserving", "volume_order", "volume_leading"),
        **agreement_json(proof),
        "entry": proof.entry,
        "witness": {name: text(value) for name, value in proof.witness.items()},
        "telescopes": proof.telescopes,
        "potential": proof.potential or None,
        "why": proof.why,
        "checked": proof.checked,
        "conditions": [asdict(condition) for condition in proof.conditions],
        "domain": proof.domain.texts,
        "special_values": [],
        "seconds": seconds,
    }


def print_symplectic(texts: Mapping[str, Any], scheme: str, proof: "SymplecticProof") -> None:
    """The same for a reader."""
    click.echo(f"{proof.verdict}: {proof.reason}")
    line("H", texts["hamiltonian"])
    for name, value in texts.get("parameters", {}).items():
        line(name, value)
    line("scheme", scheme)
    if proof.order is not None:
        long = proof.formula or proof.leading_text
        shown = proof.leading_text if len(proof.leading_text) < _LONG else long
        line("S", f"({cut(shown)})·h^{proof.order} + O(h^{proof.order + 1})")
    if proof.witness or proof.enclosure:
        line("witness", _witness(proof))
    line("det J", _of_volume(proof))
    if proof.telescopes is not None and not proof.symplectic:
        line("telescopes", _telescoping(proof))
    print_checks(proof)
    if proof.domain:
        line("where", str(proof.domain.prose))
    line("the map", f"agrees with the exact flow {agreement(proof)}")


def _witness(proof: "SymplecticProof") -> str:
    from verify.arithmetic.exact import text

    at = ", ".join(f"{n} = {text(v)}" for n, v in proof.witness.items())
    return f"{at or 'any point'}: the coefficient of {proof.entry} is {proof.enclosure}"


def _telescoping(proof: "SymplecticProof") -> str:
    if not proof.telescopes:
        return f"no: {proof.why}"
    return f"S begins with a Lie derivative, that of {cut(proof.potential)}"


def _of_volume(proof: "SymplecticProof") -> str:
    if proof.area_preserving:
        return "≡ 1" + ("" if proof.symplectic else ", and yet the map is not symplectic")
    if proof.volume_order is not None:
        order = proof.volume_order
        return f"1 + ({cut(proof.volume_leading)})·h^{order} + O(h^{order + 1})"
    return "whether it is 1 is not decided"
