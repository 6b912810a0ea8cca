"""The command `verify certificate`: certificates of proofs, checked by other code."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared.command_group import CommandGroup
from verify.commands.shared.destinations import OUT_FILE, OUT_FOLDER
from verify.commands.shared.input import PATH
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, answering
from verify.files import open_regular_file, write_atomically

if TYPE_CHECKING:
    from verify.proof.certificates.established_statement import EstablishedStatement

_MAX_CHARACTERS = 400  # the limit for a formula on a terminal


@click.group(cls=CommandGroup)
def certificate() -> None:
    """Certificates of proofs: `verify prove … --certificate FILE` writes one."""


@certificate.command()
@click.argument("file", type=PATH, metavar="FILE")
@answering
def check(file: Path) -> CommandAnswer:
    """Check FILE by arithmetic with integers alone; exit status 1 if it proves nothing."""
    from verify.proof.certificates.certificate_file import check_file

    outcome = check_file(file)
    if isinstance(outcome, str):
        refusal = {"accepted": False, "reason": outcome}
        return CommandAnswer(
            lambda: refusal, lambda: click.echo(f"refused: {outcome}"), failed=True
        )
    return CommandAnswer(lambda: {"accepted": True, **asdict(outcome)}, lambda: _print(outcome))


def _check_opens(context: click.Context, parameter: click.Parameter, file: Path) -> Path:
    """Return the file if it can be opened.

    As a callback this runs before click reports a missing --coq.
    """

    with open_regular_file(file):
        return file


@certificate.command()
@click.argument("file", type=PATH, metavar="FILE", callback=_check_opens)
@option("--coq", "OUT.v", "Write the proof to this file.", type=OUT_FILE, required=True)
@flag(
    "--beside-theory",
    "Import the theory, which `verify certificate theory` installs, instead of including it.",
)
@answering
def export(file: Path, coq: Path, beside_theory: bool) -> CommandAnswer:
    """Write the statement that FILE certifies, with its proof, for Rocq: `coqc OUT.v` accepts it.

    OUT.v stands alone, and begins with the theory that it needs, unless --beside-theory is given.

    \b
    verify certificate export lie2.json --coq lie2.v
    """
    from verify.proof.assistant.certificate_export import check_file_name, export_certificate

    check_file_name(coq)
    proof_file = export_certificate(file, stands_alone=not beside_theory)
    write_atomically(coq, proof_file.text)
    data = {
        "written": str(coq),
        "statement": proof_file.facts.statement,
        "theorems": list(proof_file.theorems),
        "stands_alone": not beside_theory,
    }

    def show() -> None:
        click.echo(f"{coq}: {proof_file.facts.statement}")
        click.echo(f"  proves {', '.join(proof_file.theorems)}")
        how = "coqc -Q THEORY AreaPreservation" if beside_theory else "coqc"
        click.echo(f"  check  {how} {coq}")

    return CommandAnswer(lambda: data, show)


@certificate.command()
@click.argument("folder", type=OUT_FOLDER, metavar="FOLDER")
@answering
def theory(folder: Path) -> CommandAnswer:
    """Write the theory that exported certificates import to FOLDER, with a _CoqProject."""
    from verify.proof.assistant.shipped_theory import LOGICAL, install

    files = install(folder)
    data = {"written": [str(path) for path in files], "logical_name": LOGICAL}

    def show() -> None:
        click.echo(f"{folder}: {len(files)} files, of the logical name {LOGICAL}")
        click.echo(f"  compile  cd {folder} && coq_makefile -f _CoqProject -o Makefile && make")

    return CommandAnswer(lambda: data, show)


def _print(facts: "EstablishedStatement") -> None:
    click.echo(f"holds: {facts.statement}")
    lines = {
        "H": facts.hamiltonian,
        **_number_formulas("p", facts.p_next),
        **_number_formulas("q", facts.q_next),
        "L": facts.leading,
        "G": facts.potential,
        "map": facts.scheme,
        "where": ", ".join(facts.domain),
    }
    rows = [*lines.items(), *(("with", number) for number in facts.numbers)]
    for name, text in rows:
        if text:
            cut = f"{text[:_MAX_CHARACTERS]} … ({len(text):,} characters; all of it with --json)"
            click.echo(f"  {name:<5}  {text if len(text) <= _MAX_CHARACTERS else cut}")


def _number_formulas(letter: str, formulas: str | tuple[str, ...]) -> dict[str, str]:
    """Return the formulas of the new values by their names: p', or p1', p2', …."""
    if isinstance(formulas, str):
        return {f"{letter}'": formulas}
    return {f"{letter}{k}'": text for k, text in enumerate(formulas, start=1)}
