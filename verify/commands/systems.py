"""The command `verify systems`: the named Hamiltonians."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.output import CommandAnswer, answering, pick

if TYPE_CHECKING:
    from verify.hamiltonians.named_system import System


@click.command()
@answering
def systems() -> CommandAnswer:
    """List the named systems: H, its parameters, its regimes, the form of its exact flow.

    \b
    verify systems
    verify systems --json
    """
    from verify.hamiltonians.systems import all_systems

    rows = [_row_json(system) for system in all_systems(None).values()]
    return CommandAnswer(lambda: {"systems": rows}, lambda: _print(rows))


def _row_json(system: "System") -> dict[str, Any]:
    return {
        **pick(system, "name", "title"),
        "hamiltonian": system.formula,
        "degrees": system.degrees,
        "parameters": dict(system.parameters),
        "regimes": {name: dict(values) for name, values in system.regimes.items()},
        "exact_flow": system.has_closed_form,
        "source": system.source,
    }


def _print(rows: list[dict[str, Any]]) -> None:
    width = max(len(row["name"]) for row in rows)
    for row in rows:
        flow = "exact flow in closed form" if row["exact_flow"] else "exact flow by numbers"
        flow = flow if row["degrees"] == 1 else f"{row['degrees']} degrees of freedom"
        flow += ", more or fewer with n" if "n" in row["parameters"] else ""
        click.echo(f"{row['name']:{width}}  H = {row['hamiltonian']}; {flow}")
        for name, meaning in row["parameters"].items():
            click.echo(f"{'':{width}}  {name}: {meaning}")
        if row["regimes"]:
            click.echo(f"{'':{width}}  regimes: {', '.join(row['regimes'])}")
