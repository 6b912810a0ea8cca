"""Output of proofs, as JSON and as lines.

In the plane a proof is about ΔJ = det J − 1, in n degrees of freedom about S = JᵀΩJ − Ω.
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Protocol, cast

import click

from verify.commands.shared.output import cut, pick, print_line

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.integrators.results import Finding
    from verify.proof.plane.potential import Potential
    from verify.proof.proof_for_every_h import ProofForEveryH
    from verify.proof.proof_for_one_h import Proof
    from verify.proof.special_values import SpecialValue
    from verify.proof.structures.structures_proof import StructuresProof

_MAX_LEADING_CHARACTERS = 352  # instead of a longer leading coefficient of S its formula is printed


class Agreeing(Protocol):
    """A proof that says how far the map agrees with the exact flow."""

    @property
    def convergence_order(self) -> int | None: ...
    @property
    def convergence_decided(self) -> bool: ...


def describe_agreement(proof: Agreeing) -> str:
    """Return the order of consistency in words, with a remark if it may be higher."""
    order = proof.convergence_order
    if order is None:
        return "in all powers of h that were looked at"
    remark = "" if proof.convergence_decided else "; whether further is not decided"
    return (f"up to h^{order}" if order >= 0 else "not even at h = 0") + remark


def agreement_json(proof: Agreeing) -> dict[str, Any]:
    """Return the order of consistency as JSON, and True if it is known that no higher one holds."""
    order = proof.convergence_order
    is_decided = order is not None and proof.convergence_decided
    return {"convergence_order": order, "convergence_order_known": is_decided}


def order_json(order: int | None) -> dict[str, int | None]:
    """Return the order of ΔJ or of S as `order`, and as the unambiguous `defect_order`."""
    return {"order": order, "defect_order": order}


def proof_json(
    texts: "Mapping[str, Any]", scheme: str, proof: "Proof | ProofForEveryH", **more_keys: Any
) -> dict[str, Any]:
    """Return the keys of every proof, and `more_keys`, which also replace keys of the same names.

    `texts`: H and its parameters, or a description of every H.
    """
    return {
        **pick(proof, "verdict", "reason"),
        **texts,
        "scheme": scheme,
        **order_json(proof.order),
        "leading": proof.leading_text or None,
        "delta_j": "0" if proof.area_preserving else None,
        **pick(proof, "symplectic", "area_preserving"),
        **agreement_json(proof),
        "domain": proof.domain.texts,
        "special_values": [],
        **more_keys,
    }


def checks_json(proof: "Proof | ProofForEveryH") -> dict[str, Any]:
    """Return the keys of the leading coefficient and of its checks; for S its entry and det J."""
    from dataclasses import asdict

    keys_of_s = ("degrees", "entry", "volume_order", "volume_leading")
    point = {"witness": point_json(getattr(proof, "witness", {}))}  # a proof for every H has none
    return {
        **({**pick(proof, *keys_of_s), **point} if proof.degrees > 1 else {}),
        **pick(proof, "telescopes", "why", "checked"),
        "formula": proof.formula or None,
        "potential": proof.potential or None,
        "conditions": [asdict(condition) for condition in proof.conditions],
    }


def point_json(point: "Mapping[str, Fraction]") -> dict[str, str]:
    """Return a point as exact numbers, for JSON."""
    from verify.arithmetic.exact import text

    return {name: text(value) for name, value in point.items()}


def point_text(point: "Mapping[str, Fraction]") -> str:
    """Return a point as a line of names with exact numbers."""
    return ", ".join(f"{name} = {value}" for name, value in point_json(point).items())


# -- as lines ------------------------------------------------------------------------------------


def print_head(
    hamiltonian: "Hamiltonian", scheme: str, result: "Proof | Finding | StructuresProof"
) -> None:
    """Print the verdict, H with its parameters, and the scheme."""
    click.echo(f"{result.verdict}: {result.reason}")
    name = "field" if hamiltonian.energy is None else "H"
    click.echo(f"  {name:8} {hamiltonian.formula}")
    for name, value in hamiltonian.texts["parameters"].items():
        click.echo(f"  {name:8} {value}")
    click.echo(f"  scheme   {scheme}")


def print_checks(proof: "Proof | ProofForEveryH") -> None:
    """Print the identities that were checked, and the conditions that decide."""
    for identity in proof.checked:
        print_line("checked", str(identity))
    for condition in proof.conditions:
        status = "holds" if condition.holds else f"residue {condition.residue}"
        print_line("condition", f"{condition.name}: {status}")


def print_proof(
    hamiltonian: "Hamiltonian",
    scheme: str,
    proof: "Proof",
    potential: "Potential",
    closed: str | None,
    special: "Iterable[SpecialValue]" = (),
) -> None:
    """Print the proof of the order; `closed`: the formula of ΔJ, None if that is too large."""
    print_head(hamiltonian, scheme, proof)
    if proof.order is not None:
        click.echo(f"  ΔJ       ({cut(proof.first.text)})·h^{proof.order} + O(h^{proof.order + 1})")
        point = point_text(proof.witness) or "any point"
        click.echo(f"  witness  {point}: the coefficient is {proof.enclosure}")
    formula = "left out: the closed form is too large" if closed is None else cut(closed)
    click.echo(f"  exactly  ΔJ = {formula}")
    operator = "D" if hamiltonian.time_dependent else "X"  # D = ∂_t + X
    if potential.text is not None and proof.order is not None:
        g = cut(potential.text)
        click.echo(f"  along an orbit the leading term telescopes: it is {operator}·G, G = {g}")
    elif potential.holds is False:
        click.echo(f"  along an orbit the leading term does not telescope: {potential.reason}")
    if proof.domain:
        click.echo(f"  where    {proof.domain.prose}")
    click.echo(f"  the map  agrees with the exact flow {describe_agreement(proof)}")
    for case in special:
        click.echo(f"  but at   {case.parameter} = {case.value}: {case.proof.reason}")


def print_symplectic(
    texts: Mapping[str, Any], scheme: str, proof: "Proof | ProofForEveryH"
) -> None:
    """Print the proof of S and of det J; `texts`: H and its parameters, or words for every H."""
    click.echo(f"{proof.verdict}: {proof.reason}")
    print_line("H", texts["hamiltonian"])
    for name, value in texts.get("parameters", {}).items():
        print_line(name, value)
    print_line("scheme", scheme)
    if proof.order is not None:
        short_formula = proof.formula or proof.leading_text
        formula = (
            proof.leading_text
            if len(proof.leading_text) < _MAX_LEADING_CHARACTERS
            else short_formula
        )
        print_line("S", f"({cut(formula)})·h^{proof.order} + O(h^{proof.order + 1})")
    if getattr(proof, "witness", None) or getattr(proof, "enclosure", ""):  # a proof for one H
        print_line("witness", _describe_witness(cast("Proof", proof)))
    print_line("det J", _describe_volume(proof))
    if proof.telescopes is not None and not proof.symplectic:
        print_line("telescopes", _describe_telescoping(proof))
    print_checks(proof)
    if proof.domain:
        print_line("where", str(proof.domain.prose))
    print_line("the map", f"agrees with the exact flow {describe_agreement(proof)}")


def _describe_witness(proof: "Proof") -> str:
    point = point_text(proof.witness) or "any point"
    return f"{point}: the coefficient of {proof.entry} is {proof.enclosure}"


def _describe_telescoping(proof: "Proof | ProofForEveryH") -> str:
    if not proof.telescopes:
        return f"no: {proof.why}"
    return f"S begins with a Lie derivative, that of {cut(proof.potential or '')}"


def _describe_volume(proof: "Proof | ProofForEveryH") -> str:
    if proof.area_preserving:
        return "≡ 1" + ("" if proof.symplectic else ", and yet the map is not symplectic")
    if proof.volume_order is not None:
        order = proof.volume_order
        return f"1 + ({cut(proof.volume_leading)})·h^{order} + O(h^{order + 1})"
    return "whether it is 1 is not decided"
