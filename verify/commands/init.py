"""The command `verify init`: a commented file to begin with."""

from pathlib import Path

import click

from verify.commands.shared.destinations import OUT_FILE
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering
from verify.content import content
from verify.errors import InputError

# What is done next with each kind of file.
_NEXT = {
    "claims": "verify check {0}, or verify report {0} -o page",
    "scene": "verify plan {0}, or verify report {0} -o page",
    "table": "verify check-table {0}",
}


@click.command()
@click.argument("kind", metavar="claims|scene|table", type=click.Choice([*_NEXT]))
@option("-o --output", "FILE", "The file.  [default: KIND.toml]", type=OUT_FILE)
@answering
def init(kind: str, output: Path | None) -> CommandAnswer:
    """Write a commented file to begin with: claims, a scene, or a table of coefficients.

    A file that is there is left alone.

    \b
    verify init claims
    verify init scene -o pendulum.toml
    verify init table
    """
    path = output or Path(f"{kind}.toml")
    text = content("reports", "first-files", f"{kind}.toml").read_text("utf-8")
    text = text.replace(f" {kind}.toml", f" {path}")
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        problem = "is there already; give another with -o"
        raise InputError("--output", str(path), problem) from None
    except OSError as error:
        raise InputError("--output", str(path), str(error.strerror)) from None
    step = _NEXT[kind].format(path)
    return CommandAnswer(
        lambda: {"kind": kind, "file": str(path)}, lambda: click.echo(f"{path}: next, {step}")
    )
