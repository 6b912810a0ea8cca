"""The command `verify export`: a step map, its Jacobian and ΔJ as code."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.destinations import OUT_FILE
from verify.commands.shared.input import scheme_option, with_hamiltonian
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian


@click.command()
@with_hamiltonian
@scheme_option
@answering
@option("--language", "NAME", "c, python, julia or latex.", default="python", show_default=True)
@option(
    "--name",
    "NAME",
    "The name of the function that makes a step.",
    default="step",
    show_default=True,
)
@option("-o --output", "FILE", "Write to this file instead of standard output.", type=OUT_FILE)
def export(
    hamiltonian: "Hamiltonian", scheme: str, language: str, name: str, output: Path | None
) -> CommandAnswer:
    """Write a step map, its Jacobian and ΔJ as C, Python, Julia or LaTeX.

    A parameter without a value becomes an argument, and so does t if H depends on it. Constants
    are the doubles nearest to the exact numbers, which comments beside them give.

    \b
    verify export --system duffing --scheme lie2 --language c
    verify export --system pendulum --scheme yoshida4 --language latex
    verify export --system driven-pendulum --scheme stormer-verlet --language julia
    """
    from verify.calls.export import build_program
    from verify.files import write_atomically
    from verify.schemes.export import get

    step_program = build_program(hamiltonian, scheme, language, name=name)
    text = get(language).render(step_program)
    if output is not None:
        write_atomically(output, text)

    def data() -> dict[str, Any]:
        return {
            "language": language.lower(),
            "scheme": step_program.scheme,
            **hamiltonian.texts,
            "arguments": list(step_program.arguments),
            "area_preserving": step_program.area_preserving,
            "constants": [asdict(c) for c in step_program.constants],
            "code": text,
        }

    output_text = str(output) if output is not None else text.removesuffix("\n")
    return CommandAnswer(data, lambda: click.echo(output_text))
