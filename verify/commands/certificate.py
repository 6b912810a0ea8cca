"""The command `verify certificate`: what a certificate establishes, checked by other code."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared.answer import Answer, answering
from verify.commands.shared.destinations import OUT_FILE, OUT_FOLDER
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


def _opened(context: click.Context, parameter: click.Parameter, file: Path) -> Path:
    """The file, where it can be opened: it is looked for before an option is missed."""
    from verify.files import opened

    with opened(file):
        return file


@certificate.command()
@click.argument("file", type=PATH, metavar="FILE", callback=_opened)
@click.option("--coq", type=OUT_FILE, required=True, metavar="OUT.v", help="Write it there.")
@click.option(
    "--beside-theory",
    is_flag=True,
    help="Import the theory, which `verify certificate theory` installs, in place of holding it.",
)
@answering
def export(file: Path, coq: Path, beside_theory: bool) -> Answer:
    """Write what FILE certifies as a proof for Rocq, which `coqc OUT.v` accepts.

    It stands alone: it begins with the theory that it needs.

    \b
    verify certificate export lie2.json --coq lie2.v
    """
    from verify.files import write_atomically
    from verify.proof.assistant.export import check_file_name, exported

    check_file_name(coq)
    found = exported(file, stands_alone=not beside_theory)
    write_atomically(coq, found.text)
    data = {
        "written": str(coq),
        "statement": found.of.statement,
        "theorems": list(found.theorems),
        "stands_alone": not beside_theory,
    }

    def told() -> None:
        click.echo(f"{coq}: {found.of.statement}")
        click.echo(f"  proves {', '.join(found.theorems)}")
        how = "coqc -Q THEORY AreaPreservation" if beside_theory else "coqc"
        click.echo(f"  check  {how} {coq}")

    return Answer(lambda: data, told)


@certificate.command()
@click.argument("folder", type=OUT_FOLDER, metavar="FOLDER")
@answering
def theory(folder: Path) -> Answer:
    """Write the theory that exported certificates stand on to FOLDER, with a _CoqProject."""
    from verify.proof.assistant.shipped import LOGICAL, install

    written = install(folder)
    data = {"written": [str(path) for path in written], "logical_name": LOGICAL}

    def told() -> None:
        click.echo(f"{folder}: {len(written)} files, of the logical name {LOGICAL}")
        click.echo(f"  compile  cd {folder} && coq_makefile -f _CoqProject -o Makefile && make")

    return Answer(lambda: data, told)


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
