"""What the command line prints: JSON objects with decimal strings, and short texts for people."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from verify.hamiltonian import Hamiltonian
    from verify.proof.order import Proof
    from verify.results import Report, RunResult

_LABELS = {
    "lambda": "Λ",
    "lambda_plain": "Λ, plain",
    "mse": "MSE",
    "delta_j_max": "max |ΔJ|",
    "q": "q",
    "p": "p",
}


def print_json(data: dict[str, Any]) -> None:
    click.echo(json.dumps(data, ensure_ascii=False))


def proof_json(exact: "Hamiltonian", scheme: str, proof: "Proof", seconds: str) -> dict[str, Any]:
    from verify.exact import text
    from verify.formula import to_text

    return {
        "verdict": proof.verdict.value,
        "reason": proof.reason,
        "hamiltonian": to_text(exact.expression),
        "parameters": {name: text(value) for name, value in exact.values},
        "scheme": scheme,
        "order": proof.order,
        "leading": to_text(proof.leading),
        "delta_j": to_text(proof.delta_j),
        "area_preserving": proof.area_preserving,
        "convergence_order": proof.convergence_order,
        "witness": {name: text(value) for name, value in proof.witness.items()},
        "telescopes": None,  # not examined by this command yet
        "potential": None,
        "seconds": seconds,
    }


def print_proof(exact: "Hamiltonian", scheme: str, proof: "Proof") -> None:
    from verify.exact import text
    from verify.formula import to_text

    click.echo(f"{proof.verdict}: {proof.reason}")
    click.echo(f"  H        {to_text(exact.expression)}")
    for name, value in exact.values:
        click.echo(f"  {name:8} {text(value)}")
    click.echo(f"  scheme   {scheme}")
    if proof.order is not None:
        click.echo(
            f"  ΔJ       ({to_text(proof.leading)})·h^{proof.order} + O(h^{proof.order + 1})"
        )
        at = ", ".join(f"{n} = {text(v)}" for n, v in proof.witness.items())
        click.echo(f"  witness  {at or 'any point'}: the coefficient is {proof.enclosure}")
    click.echo(f"  exactly  ΔJ = {to_text(proof.delta_j)}")
    order = proof.convergence_order
    agreement = "to every order looked at" if order is None else f"up to h^{order}"
    click.echo(f"  the map  agrees with the exact flow {agreement}")


def run_json(result: "RunResult") -> dict[str, Any]:
    values = {name: result.values.get(name) for name in _LABELS}
    return {
        **{name: value.value if value else None for name, value in values.items()},
        "steps": result.steps,
        "digits": result.digits,
        "arithmetic": result.arithmetic,
        "error_bound": {name: value.bound for name, value in values.items() if value},
        "error_kind": result.error_kind,
        "error_method": result.error_method,
        "exact": list(result.exact),  # what a proof gave, and no run
        "status": result.status,
        "failed_step": result.failed_step,
        "seconds": f"{result.seconds:.6f}",
    }


def print_run(result: "RunResult") -> None:
    if result.status == "unresolved":
        click.echo(f"no digit is known: {result.error_method}")
        return
    if result.status != "finished":
        click.echo(
            f"at step {result.failed_step} the orbit leaves the domain of H or the range of "
            f"{result.arithmetic} (other than float64 stops beyond 2^4000)"
        )
        return
    for name, label in _LABELS.items():
        if name in result.values:
            value = result.values[name]
            click.echo(f"{label:10} {value.value}  ± {value.bound}")
    click.echo(
        f"{result.steps} steps in {result.arithmetic}, {result.seconds:.3g} s; bounds "
        f"{result.error_kind} ({result.error_method})"
    )


def print_plan(planned: dict[str, Any]) -> None:
    click.echo(f"{len(planned['tasks'])} tasks")
    for task in planned["tasks"]:
        click.echo(f"  {_task_line(task)}")
    click.echo(f"{len(planned['left_out'])} left out")
    for item in planned["left_out"]:
        click.echo(f"  {item['what']}: {item['why']}")


def _task_line(task: dict[str, Any]) -> str:
    reasons = "; ".join(task["reasons"])
    if task["kind"] == "proof":
        return f"prove {task['scheme']} for H = {task['hamiltonian']} ({reasons})"
    return (
        f"run {task['scheme']}, {task['steps']} steps of {task['step_size']} from "
        f"q = {task['q']}, p = {task['p']} in {task['arithmetic']} ({reasons})"
    )


def print_report(made: "Report", page: Path) -> None:
    for claim in made.claims:
        click.echo(f"{claim.verdict:9}  {claim.source}: {claim.evidence}")
    for scene in made.scenes:
        for c in scene.criteria:
            click.echo(f"{c.verdict:9}  {scene.name}, {c.scheme}, criterion {c.number}")
    click.echo(f"{page} ({made.provenance.seconds:.3g} s)")
