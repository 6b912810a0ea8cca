"""Results as commands tell them: JSON objects with decimal strings, short texts for people."""

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import click

from verify import observables
from verify.commands.shared.answer import picked

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from fractions import Fraction

    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.integrators.results import Finding
    from verify.proof.every_proof import EveryProof
    from verify.proof.plane.potential import Potential
    from verify.proof.proof import Proof
    from verify.proof.special_values import SpecialValue
    from verify.scenes.frozen import Frozen
    from verify.scenes.results.report import Report
    from verify.scenes.results.run import RunResult

_WIDTH, _NAMES = 88, 10  # of a line, and of the name that it begins with
_LONGEST = 400  # characters of a formula on the terminal


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


def cut(formula: str) -> str:
    """A formula as it is, or its beginning where it is long: the JSON has all of it."""
    if len(formula) <= _LONGEST:
        return formula
    terms = formula.count(" + ") + formula.count(" - ") + 1
    return f"{formula[:_LONGEST].rsplit(' ', 2)[0]} … ({terms} terms; --json has them)"


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


def line(name: str, text: str) -> None:
    """A name and what it is, wrapped."""
    first, rest = f"  {name:{_NAMES}} ", " " * (_NAMES + 3)
    click.echo(textwrap.fill(text, _WIDTH, initial_indent=first, subsequent_indent=rest))


def print_checks(proof: "EveryProof | Proof") -> None:
    """The identities that were checked, and the conditions that decide."""
    for identity in proof.checked:
        line("checked", str(identity))
    for condition in proof.conditions:
        found = "holds" if condition.holds else f"residue {condition.residue}"
        line("condition", f"{condition.name}: {found}")


def print_head(exact: "Hamiltonian", scheme: str, found: "Proof | Finding") -> None:
    """The verdict, and of what it is."""
    click.echo(f"{found.verdict}: {found.reason}")
    click.echo(f"  H        {exact.formula}")
    for name, value in exact.texts["parameters"].items():
        click.echo(f"  {name:8} {value}")
    click.echo(f"  scheme   {scheme}")


def print_proof(
    exact: "Hamiltonian",
    scheme: str,
    proof: "Proof",
    potential: "Potential",
    special: "Iterable[SpecialValue]" = (),
) -> None:
    from verify.arithmetic.exact import text

    print_head(exact, scheme, proof)
    if proof.order is not None:
        click.echo(f"  ΔJ       ({cut(proof.first.text)})·h^{proof.order} + O(h^{proof.order + 1})")
        at = ", ".join(f"{n} = {text(v)}" for n, v in proof.witness.items())
        click.echo(f"  witness  {at or 'any point'}: the coefficient is {proof.enclosure}")
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


def run_json(result: "RunResult") -> dict[str, Any]:
    from verify.scenes.observables import REPORTED, names

    # A key for each that is usual, and for what was computed beside them.
    every, planar = observables.by_name(), isinstance(result.q, str)
    there = dict.fromkeys((*names(planar=planar), *REPORTED))
    told = (n for n in there if every[n].usual or n in REPORTED or n in result.values)
    values = {name: _told(result, name) for name in (*told, "q", "p")}
    return {
        **{name: value for name, (value, _) in values.items()},
        **picked(result, "steps", "digits", "arithmetic", "fallback", "left_domain"),
        "error_bound": {name: bound for name, (_, bound) in values.items() if bound},
        # `exact`: what a proof gave, and no run.
        **picked(result, "error_kind", "error_method", "exact", "status", "failed_step"),
        "seconds": f"{result.seconds:.6f}",
    }


def _told(result: "RunResult", name: str) -> tuple[Any, Any]:
    """A value and its bound; lists of q and of p in n degrees of freedom."""
    if name in ("q", "p") and not isinstance(result.q, str):
        own = [x for n, x in result.values.items() if n[0] == name and n[1:].isdigit()]
        return ([x.value for x in own], [x.bound for x in own]) if own else (None, None)
    value = result.values.get(name)
    return (value.value, value.bound) if value else (None, None)


def unfinished(result: "RunResult") -> str:
    """Why a run has no numbers; empty where it has."""
    if result.status == "finished":
        return ""
    if result.status == "unresolved":
        return f"no digit is known: {result.error_method}"
    return (
        f"at step {result.failed_step} the orbit leaves the domain of H or the range of "
        f"{result.arithmetic} (other than float64 stops beyond 2^4000)"
    )


def print_once(notes: "Iterable[str]") -> None:
    """Each of the notes on a line, once; those that are empty say nothing."""
    for note in filter(None, dict.fromkeys(notes)):
        click.echo(note)


def print_run(result: "RunResult") -> None:
    if result.status != "finished":
        click.echo(unfinished(result))
        return
    labels = {name: each.short or each.label for name, each in observables.by_name().items()}
    coordinates = {name: name for name in result.values if name[1:].isdigit()}
    for name, label in {**labels, "q": "q", "p": "p", **coordinates}.items():
        if name in result.values:
            value = result.values[name]
            shown = str(value) if value.unknown else f"{value.value}  ± {value.bound}"
            click.echo(f"{label:10} {shown}")
    click.echo(
        f"{result.steps} steps in {result.arithmetic}, {result.seconds:.3g} s; bounds "
        f"{result.error_kind} ({result.error_method})"
    )
    if result.fallback:
        click.echo(f"taken instead of what was asked for: {result.fallback}")
    if result.left_domain:
        click.echo(result.left_domain)


def plain_json(model: "Frozen") -> dict[str, Any]:
    """The model as JSON, without the parts of its texts."""
    from verify.scenes.frozen import PLAIN

    data: dict[str, Any] = model.model_dump(mode="json", context=PLAIN)
    return data


def print_report(made: "Report", *pages: Path) -> None:
    from verify.scenes.results.statement import counted

    for line in made.preface:
        click.echo(line)
    for claim in made.claims:
        click.echo(f"{claim.verdict:9}  {claim.source}: {claim.evidence}")
    if made.statements:
        click.echo(counted(made.statements, made.claims))
    for scene in made.scenes:
        for c in scene.criteria:
            click.echo(f"{c.verdict:9}  {scene.name}, {c.scheme}, criterion {c.number}")
    click.echo(f"{', '.join(map(str, pages))} ({made.provenance.seconds:.3g} s)")
