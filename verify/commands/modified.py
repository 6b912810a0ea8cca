"""The command `verify modified`, for one Hamiltonian or for every one."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import proof_output as show
from verify.commands.shared.input import (
    every_options,
    hamiltonian_options,
    one_or_every,
    scheme_option,
)
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering, cut, pick

if TYPE_CHECKING:
    from verify.proof.plane.modified_equation import ModifiedEquation, Term


@click.command()
@hamiltonian_options
@scheme_option
@answering
@option(
    "--order",
    "N",
    "The highest power of h in H̃: 1 … 10, for every H 1 … 8.",
    type=int,
    default=4,
    show_default=True,
)
@every_options
def modified(
    scheme: str, order: int, every_hamiltonian: bool, separable: bool, **options: Any
) -> CommandAnswer:
    """Find the energy that a scheme keeps, H̃ = H + h H_2 + …, by exact algebra.

    The map is the exact flow of a modified field, as a series in h. A term of the field that is
    Hamiltonian gives a term of H̃; the first that is not is printed with its divergence.

    \b
    verify modified --system pendulum --scheme stormer-verlet
    verify modified --every-hamiltonian --scheme implicit-midpoint --order 2
    """
    from verify.calls.prove import modified_hamiltonian

    hamiltonian = one_or_every(every_hamiltonian, options, separable=separable)
    equation = modified_hamiltonian(scheme, hamiltonian, order, separable=separable)
    return CommandAnswer(
        lambda: _json(equation),
        lambda: _print(equation),
        failed=equation.verdict == "REFUTED",
        timed=True,
    )


def _json(equation: "ModifiedEquation") -> dict[str, Any]:
    non_hamiltonian = equation.first_not_hamiltonian
    return {
        **pick(equation, "verdict", "reason", "hamiltonian", "scheme", "order"),
        "terms": [_term_json(term) for term in equation.terms],
        "modified_hamiltonian": equation.text,
        "known_to": equation.reach,
        "first_not_hamiltonian": non_hamiltonian.power if non_hamiltonian else None,
        "divergence_is_leading_delta_j": equation.area,
        "domain": equation.domain.texts,
    }


def _term_json(term: "Term") -> dict[str, Any]:
    return {
        "power": term.power,
        "field": {"p": term.p, "q": term.q},
        **pick(term, "hamiltonian", "is_hamiltonian", "divergence"),
        "witness": show.point_json(term.witness),
    }


def _print(equation: "ModifiedEquation") -> None:
    click.echo(f"{equation.verdict}: {equation.reason}")
    click.echo(f"  H        {equation.hamiltonian}")
    click.echo(f"  scheme   {equation.scheme}")
    for term in equation.terms:
        _print_term(term, f"h^{term.power}")
        if term.is_hamiltonian is False:
            break
    non_hamiltonian = equation.first_not_hamiltonian
    if non_hamiltonian is not None and equation.area:
        power = non_hamiltonian.power + 1
        click.echo(f"  checked  the leading term of ΔJ is h^{power} times that divergence")
    if equation.reach >= 0:
        remainder = (
            f" + O(h^{equation.reach + 1})"
            if non_hamiltonian is None
            else f", to h^{equation.reach} only"
        )
        click.echo(f"  H̃        {cut(equation.text)}{remainder}")
    if equation.domain:
        click.echo(f"  where    {equation.domain.prose}")


def _print_term(term: "Term", name: str) -> None:
    if term.hamiltonian is not None:
        click.echo(f"  {name:8} {cut(term.hamiltonian)}")
        return
    click.echo(f"  {name:8} p' = {cut(term.p)}, q' = {cut(term.q)}")
    click.echo(f"  {'':8} divergence {cut(term.divergence)}")
    if term.is_hamiltonian is False and (point := show.point_text(term.witness)):
        click.echo(f"  witness  {point}: the divergence is {term.enclosure}")
