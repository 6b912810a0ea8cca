"""How a proof in n degrees of freedom is printed, and what its JSON has."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import picked
from verify.commands.shared.output import agreement, agreement_json, cut, line, order_json

if TYPE_CHECKING:
    from verify.integrators.degrees.results import StepFinding
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


def step_json(
    texts: Mapping[str, Any], target: str, found: "StepFinding", seconds: str
) -> dict[str, Any]:
    """Of a step of one's own: the keys of a proof where there is one, and what was measured."""
    from verify.arithmetic.exact import text

    proof = found.proof
    seen = found.measured
    against = {} if seen is None else seen.counterexample or {}
    of_proof = proof.witness if proof and not proof.symplectic else {}
    return {
        **picked(found, "verdict", "reason"),
        **texts,
        "degrees": found.degrees,
        "integrator": target,
        **picked(found, "how", "symplectic", "area_preserving"),
        **order_json(proof.order if proof else None),
        "leading": proof.leading_text if proof else None,
        "volume_order": proof.volume_order if proof else None,
        "convergence_order": found.convergence_order,
        "convergence_order_known": found.order_known,
        "telescopes": proof.telescopes if proof else None,
        "entry": proof.entry if proof else (seen.entry if seen else ""),
        "witness": {name: text(value) for name, value in (of_proof or against).items()},
        "value": proof.enclosure if proof else (seen.value if seen else ""),
        "step_size": None if found.h is None else text(found.h),
        "probe_error": None if seen is None else f"{seen.probe_error:.1e}",
        "domain": found.domain.texts,
        **picked(found, "notes"),
        "seconds": seconds,
    }


def print_step(texts: Mapping[str, Any], target: str, found: "StepFinding") -> None:
    """The same for a reader."""
    if found.proof is not None:
        shown = replace(
            found.proof, verdict=found.verdict, reason=found.reason, domain=found.domain
        )
        print_symplectic(texts, target, shown)
    else:
        click.echo(f"{found.verdict}: {found.reason}")
        line("H", texts["hamiltonian"])
        line("scheme", target)
        seen = found.measured
        if seen is not None:
            line(
                "measured",
                f"|S| up to {seen.largest:.1e}; the probe's error {seen.probe_error:.1e}",
            )
        if seen is not None and seen.counterexample is not None:
            at = ", ".join(f"{name} = {x}" for name, x in seen.counterexample.items())
            line("against", f"{seen.entry} has {seen.value} at {at}, h = {found.h}")
    for note in found.notes:
        line("note", str(note))


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
    for identity in proof.checked:
        line("checked", str(identity))
    for condition in proof.conditions:
        found = "holds" if condition.holds else f"residue {condition.residue}"
        line("condition", f"{condition.name}: {found}")
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
