"""How a proof in n degrees of freedom is printed."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

import click

from verify.commands.shared.output import agreement, cut, line, print_checks

if TYPE_CHECKING:
    from verify.proof.every_proof import EveryProof
    from verify.proof.proof import Proof
_LONG = 352  # characters of S, beyond which its formula stands for it


def print_symplectic(texts: Mapping[str, Any], scheme: str, proof: "Proof | EveryProof") -> None:
    """What is proved of S, and beside it of det J; `texts`: H and its parameters, or for which H it
    is."""
    click.echo(f"{proof.verdict}: {proof.reason}")
    line("H", texts["hamiltonian"])
    for name, value in texts.get("parameters", {}).items():
        line(name, value)
    line("scheme", scheme)
    if proof.order is not None:
        long = proof.formula or proof.leading_text
        shown = proof.leading_text if len(proof.leading_text) < _LONG else long
        line("S", f"({cut(shown)})·h^{proof.order} + O(h^{proof.order + 1})")
    if getattr(proof, "witness", None) or getattr(proof, "enclosure", ""):  # of one H
        line("witness", _witness(cast("Proof", proof)))
    line("det J", _of_volume(proof))
    if proof.telescopes is not None and not proof.symplectic:
        line("telescopes", _telescoping(proof))
    print_checks(proof)
    if proof.domain:
        line("where", str(proof.domain.prose))
    line("the map", f"agrees with the exact flow {agreement(proof)}")


def _witness(proof: "Proof") -> str:
    from verify.arithmetic.exact import text

    at = ", ".join(f"{n} = {text(v)}" for n, v in proof.witness.items())
    return f"{at or 'any point'}: the coefficient of {proof.entry} is {proof.enclosure}"


def _telescoping(proof: "Proof | EveryProof") -> str:
    if not proof.telescopes:
        return f"no: {proof.why}"
    return f"S begins with a Lie derivative, that of {cut(proof.potential or '')}"


def _of_volume(proof: "Proof | EveryProof") -> str:
    if proof.area_preserving:
        return "≡ 1" + ("" if proof.symplectic else ", and yet the map is not symplectic")
    if proof.volume_order is not None:
        order = proof.volume_order
        return f"1 + ({cut(proof.volume_leading)})·h^{order} + O(h^{order + 1})"
    return "whether it is 1 is not decided"
