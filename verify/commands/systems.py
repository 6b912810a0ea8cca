"""The command `verify systems`: the named Hamiltonians, or one of them."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.output import CommandAnswer, answering, pick, print_line

if TYPE_CHECKING:
    from verify.hamiltonians.named_system import System


@click.command()
@click.argument("name", metavar="[NAME]", required=False)
@answering
def systems(name: str | None) -> CommandAnswer:
    """List the named systems: H, its parameters, its regimes, the form of its exact flow.

    With NAME, that system alone, the values of its regimes, and where it comes from.

    \b
    verify systems
    verify systems duffing
    verify systems --json
    """
    from verify.hamiltonians.systems import all_systems, get

    rows = [_row_json(x) for x in ([get(name)] if name else all_systems(None).values())]
    return CommandAnswer(
        lambda: {"systems": rows}, lambda: _print_one(rows[0]) if name else _print(rows)
    )


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
        click.echo(f"{row['name']:{width}}  H = {row['hamiltonian']}; {_describe_flow(row)}")
        for name, meaning in row["parameters"].items():
            click.echo(f"{'':{width}}  {name}: {meaning}")
        if row["regimes"]:
            click.echo(f"{'':{width}}  regimes: {', '.join(row['regimes'])}")


def _print_one(row: dict[str, Any]) -> None:
    click.echo(f"{row['name']}: {row['title']}")
    print_line("H", row["hamiltonian"])
    for name, meaning in row["parameters"].items():
        print_line(name, meaning)
    for name, values in row["regimes"].items():
        print_line("regime", f"{name}: {', '.join(f'{x} = {y}' for x, y in values.items())}")
    print_line("flow", _describe_flow(row))
    print_line("source", row["source"])


def _describe_flow(row: dict[str, Any]) -> str:
    flow = "exact flow in closed form" if row["exact_flow"] else "exact flow by numbers"
    flow = flow if row["degrees"] == 1 else f"{row['degrees']} degrees of freedom"
    return flow + (", more or fewer with n" if "n" in row["parameters"] else "")
