"""How proofs are told: as JSON, and as lines, of ΔJ in the plane and of S beyond it."""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Protocol, cast

import click

from verify.commands.shared.answer import picked
from verify.commands.shared.output import cut, line

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.integrators.results import Finding
    from verify.proof.every_proof import EveryProof
    from verify.proof.plane.potential import Potential
    from verify.proof.proof import Proof
    from verify.proof.special_values import SpecialValue

_LONG = 352  # characters of S, beyond which its formula stands for it


class Agreeing(Protocol):
    """A proof that says how far the map agrees with the exact flow."""

    @property
    def convergence_order(self) -> int | None: ...
    @property
    def convergence_decided(self) -> bool: ...


def agreement(proof: Agreeing) -> str:
    """How far a map agrees with the exact flow, and whether it may agree further."""
    order = proof.convergence_order
    if order is None:
        return "in all powers of h that were looked at"
    more = "" if proof.convergence_decided else "; whether further is not decided"
    return (f"up to h^{order}" if order >= 0 else "not even at h = 0") + more


def agreement_json(proof: Agreeing) -> dict[str, Any]:
    """The same; it is known where it is shown to agree no further."""
    order = proof.convergence_order
    known = order is not None and proof.convergence_decided
    return {"convergence_order": order, "convergence_order_known": known}


def order_json(order: int | None) -> dict[str, int | None]:
    """The order of ΔJ, or of S: `order`, and by the name that no method's order has."""
    return {"order": order, "defect_order": order}


def proof_json(
    texts: "Mapping[str, Any]",
    scheme: str,
    proof: "Proof | EveryProof",
    seconds: str,
    **differs: Any,
) -> dict[str, Any]:
    """The keys of every proof; `texts`: H and its parameters, or for which H it is; `differs`: more
    of them, or other values."""
    return {
        **picked(proof, "verdict", "reason"),
        **texts,
        "scheme": scheme,
        **order_json(proof.order),
        "leading": proof.leading_text or None,
        "delta_j": "0" if proof.area_preserving else None,
        **picked(proof, "symplectic", "area_preserving"),
        **agreement_json(proof),
        "domain": proof.domain.texts,
        "special_values": [],
        **differs,
        "seconds": seconds,
    }


def checks_json(proof: "Proof | EveryProof") -> dict[str, Any]:
    """How the leading coefficient is known, and what was checked; of S what is said beside."""
    from dataclasses import asdict

    of_form = ("degrees", "entry", "volume_order", "volume_leading")
    point = {"witness": point_json(getattr(proof, "witness", {}))}  # there is none of every H
    return {
        **({**picked(proof, *of_form), **point} if proof.degrees > 1 else {}),
        **picked(proof, "telescopes", "why", "checked"),
        "formula": proof.formula or None,
        "potential": proof.potential or None,
        "conditions": [asdict(condition) for condition in proof.conditions],
    }


def point_json(point: "Mapping[str, Fraction]") -> dict[str, str]:
    """A point, as exact numbers."""
    from verify.arithmetic.exact import text

    return {name: text(value) for name, value in point.items()}


def point_text(point: "Mapping[str, Fraction]") -> str:
    """The same in a line."""
    return ", ".join(f"{name} = {value}" for name, value in point_json(point).items())


# -- as lines ------------------------------------------------------------------------------------


def print_head(exact: "Hamiltonian", scheme: str, found: "Proof | Finding") -> None:
    """The verdict, and of what it is."""
    click.echo(f"{found.verdict}: {found.reason}")
    click.echo(f"  H        {exact.formula}")
    for name, value in exact.texts["parameters"].items():
        click.echo(f"  {name:8} {value}")
    click.echo(f"  scheme   {scheme}")


def print_checks(proof: "EveryProof | Proof") -> None:
    """The identities that were checked, and the conditions that decide."""
    for identity in proof.checked:
        line("checked", str(identity))
    for condition in proof.conditions:
        found = "holds" if condition.holds else f"residue {condition.residue}"
        line("condition", f"{condition.name}: {found}")


def print_proof(
    exact: "Hamiltonian",
    scheme: str,
    proof: "Proof",
    potential: "Potential",
    special: "Iterable[SpecialValue]" = (),
) -> None:
    print_head(exact, scheme, proof)
    if proof.order is not None:
        click.echo(f"  ΔJ       ({cut(proof.first.text)})·h^{proof.order} + O(h^{proof.order + 1})")
        at = point_text(proof.witness) or "any point"
        click.echo(f"  witness  {at}: the coefficient is {proof.enclosure}")
    closed = proof.step_map.delta_j_text
    shown = "left out: the closed form is too large" if closed is None else cut(closed)
    click.echo(f"  exactly  ΔJ = {shown}")
    by = "D" if exact.time_dependent else "X"  # D = ∂_t + X
    if potential.text is not None and proof.order is not None:
        click.echo(
            f"  along an orbit the leading term telescopes: it is {by}·G, G = {cut(potential.text)}"
        )
    elif potential.holds is False:
        click.echo(f"  along an orbit the leading term does not telescope: {potential.reason}")
    if proof.domain:
        click.echo(f"  where    {proof.domain.prose}")
    click.echo(f"  the map  agrees with the exact flow {agreement(proof)}")
    for each in special:
        click.echo(f"  but at   {each.parameter} = {each.value}: {each.proof.reason}")


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
    at = point_text(proof.witness) or "any point"
    return f"{at}: the coefficient of {proof.entry} is {proof.enclosure}"


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
