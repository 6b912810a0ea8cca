"""The command `verify certificate`: what a certificate says, checked by itself."""

from pathlib import Path

import click

from verify.commands import output as show
from verify.commands.tasks import json_option


@click.group()
def certificate() -> None:
    """Certificates of proofs: `verify prove … --certificate FILE` writes one."""


@certificate.command()
@click.argument("file", type=click.Path(path_type=Path), metavar="FILE")
@json_option
def check(file: Path, as_json: bool) -> None:
    """Check FILE with nothing but integers; exit status 1 where it proves nothing."""
    from verify.proof.certificates.file import checked

    accepted, said = checked(file)
    if as_json:
        show.print_json({"accepted": accepted, "statement" if accepted else "reason": said})
    else:
        click.echo(f"{'holds' if accepted else 'refused'}: {said}")
    raise SystemExit(0 if accepted else 1)
