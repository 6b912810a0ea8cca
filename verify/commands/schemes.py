"""The command `verify schemes`: a list of the schemes with their claims and costs."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.output import CommandAnswer, answering, pick

if TYPE_CHECKING:
    from verify.schemes.scheme import Scheme


@click.command()
@answering
def schemes() -> CommandAnswer:
    """List the schemes: the order, whether symplectic, for which H, the cost of a step.

    These are claims, which `verify prove` proves. lie1, lie2, … continue up to lie100.

    \b
    verify schemes
    verify schemes --json
    """
    from verify.schemes import aliases, get, names

    listed_schemes = [get(name) for name in names()]
    aliases_of: dict[str, list[str]] = {}
    for alias, name in aliases().items():
        aliases_of.setdefault(name, []).append(alias)
    rows = [_row_json(scheme, aliases_of.get(scheme.name, [])) for scheme in listed_schemes]
    return CommandAnswer(lambda: {"schemes": rows}, lambda: _print(rows))


def _row_json(scheme: "Scheme", aliases: list[str]) -> dict[str, Any]:
    return {
        **pick(scheme, "name", "order"),
        "symplectic": scheme.area_preserving,
        **pick(scheme, "symmetric", "explicit"),
        "hamiltonian": "H = T(p) + V(q)" if scheme.needs_separable else "every smooth H",
        "cost": getattr(scheme.every_h, "a_step", ""),
        "evaluations": scheme.evaluations,
        "aliases": aliases,
        "source": scheme.source,
    }


def _print(rows: list[dict[str, Any]]) -> None:
    width = max(len(row["name"]) for row in rows)
    for row in rows:
        words = [word for word in ("symplectic", "symmetric") if row[word]]
        words.append("explicit" if row["explicit"] else "implicit")
        also = f" (also {', '.join(row['aliases'])})" if row["aliases"] else ""
        click.echo(
            f"{row['name']:{width}}  order {row['order']}, {', '.join(words)}, "
            f"for {row['hamiltonian']}: {row['cost']}{also}"
        )
    click.echo("or your own: 'p_next = …; q_next = …', 'kick 1/2; drift 1; kick 1/2; order 2'")
