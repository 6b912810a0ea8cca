"""The command `verify schemes`: the schemes, or one of them, with their claims and costs."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.input import SCHEME
from verify.commands.shared.output import CommandAnswer, answering, pick, print_line

if TYPE_CHECKING:
    from verify.schemes.scheme import Scheme


@click.command()
@click.argument("name", metavar="[NAME]", required=False, type=SCHEME)
@answering
def schemes(name: str | None) -> CommandAnswer:
    """List the schemes: the order, whether symplectic, for which H, the cost of a step.

    These are claims, which `verify prove` proves. lie1, lie2, … continue up to lie100. With NAME,
    that scheme alone, and where it comes from.

    \b
    verify schemes
    verify schemes leapfrog
    verify schemes --json
    """
    from verify.schemes import aliases, get, names

    listed_schemes = [get(x) for x in ([name] if name else names())]
    aliases_of: dict[str, list[str]] = {}
    for alias, full_name in aliases().items():
        aliases_of.setdefault(full_name, []).append(alias)
    rows = [_row_json(scheme, aliases_of.get(scheme.name, [])) for scheme in listed_schemes]
    return CommandAnswer(
        lambda: {"schemes": rows}, lambda: _print_one(rows[0]) if name else _print(rows)
    )


def _row_json(scheme: "Scheme", aliases: list[str]) -> dict[str, Any]:
    return {
        **pick(scheme, "name", "order"),
        "symplectic": scheme.area_preserving,
        **pick(scheme, "symmetric", "explicit"),
        "hamiltonian": _describe_hamiltonians(scheme),
        "cost": getattr(scheme.every_h, "a_step", ""),
        "evaluations": scheme.evaluations,
        "aliases": aliases,
        "source": scheme.source,
    }


def _describe_hamiltonians(scheme: "Scheme") -> str:
    if scheme.formulas:
        return "the H for which it is written"
    if scheme.takes_equations:
        return "the equations of which these are the parts"
    return "H = T(p) + V(q)" if scheme.needs_separable else "every smooth H"


def _print(rows: list[dict[str, Any]]) -> None:
    width = max(len(row["name"]) for row in rows)
    for row in rows:
        also = f" (also {', '.join(row['aliases'])})" if row["aliases"] else ""
        click.echo(
            f"{row['name']:{width}}  order {row['order']}, {_describe_claims(row)}, "
            f"for {row['hamiltonian']}: {row['cost']}{also}"
        )
    click.echo("or your own: 'p_next = …; q_next = …', 'kick 1/2; drift 1; kick 1/2; order 2'")


def _print_one(row: dict[str, Any]) -> None:
    click.echo(row["name"])
    print_line("order", str(row["order"]))
    print_line("claims", _describe_claims(row))
    print_line("for", row["hamiltonian"])
    for head, value in (("a step", row["cost"]), ("also", ", ".join(row["aliases"]))):
        if value:
            print_line(head, value)
    print_line("source", row["source"])


def _describe_claims(row: dict[str, Any]) -> str:
    words = [word for word in ("symplectic", "symmetric") if row[word]]
    return ", ".join([*words, "explicit" if row["explicit"] else "implicit"])
