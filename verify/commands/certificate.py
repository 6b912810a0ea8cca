"""The command `verify certificate`: what a certificate establishes, checked by itself."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared.answer import Answer, answering
from verify.commands.shared.group import Group
from verify.commands.shared.input import PATH

if TYPE_CHECKING:
    from verify.proof.certificates.established import Established

_LONGEST = 400  # characters of a formula on a terminal


@click.group(cls=Group)
def certificate() -> None:
    """Certificates of proofs: `verify prove … --certificate FILE` writes one."""


@certificate.command()
@click.argument("file", type=PATH, metavar="FILE")
@answering
def check(file: Path) -> Answer:
    """Check FILE with nothing but integers; exit status 1 where it proves nothing."""
    from verify.proof.certificates.file import checked

    found = checked(file)
    if isinstance(found, str):
        refused = {"accepted": False, "reason": found}
        return Answer(lambda: refused, lambda: click.echo(f"refused: {found}"), failed=True)
    return Answer(lambda: {"accepted": True, **asdict(found)}, lambda: _print(found))


def _print(found: "Established") -> None:
    click.echo(f"holds: {found.statement}")
    lines = {
        "H": found.hamiltonian,
        **_numbered("p", found.p_next),
        **_numbered("q", found.q_next),
        "L": found.leading,
        "G": found.potential,
        "map": found.scheme,
        "where": ", ".join(found.domain),
    }
    shown = [*lines.items(), *(("with", number) for number in found.numbers)]
    for name, text in shown:
        if text:
            cut = f"{text[:_LONGEST]} … ({len(text):,} characters; all of it with --json)"
            click.echo(f"  {name:<5}  {text if len(text) <= _LONGEST else cut}")


def _numbered(letter: str, formulas: str | tuple[str, ...]) -> dict[str, str]:
    """The formulas of new values by what they are called: p', or p1', p2', …."""
    if isinstance(formulas, str):
        return {f"{letter}'": formulas}
    return {f"{letter}{k}'": text for k, text in enumerate(formulas, start=1)}
