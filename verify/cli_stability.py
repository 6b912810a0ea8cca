"""The command `verify stability`: linear theory, exactly."""

import click

from verify import show
from verify.errors import InputError


@click.command()
@click.option("--linear", is_flag=True, help="On the harmonic oscillator, by exact algebra.")
@click.option("--scheme", help="lie1, lie2, …, stormer-verlet, rk4, …")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
def stability(linear: bool, scheme: str | None, as_json: bool) -> None:
    """The interval of hω in which the scheme is stable on the harmonic oscillator.

    \b
    verify stability --linear --scheme lie4
    """
    if not linear:
        raise InputError("--linear", "", "is missing; scenes are not looked at yet")
    if scheme is None:
        raise InputError("--scheme", "", "is missing")
    from verify.formula import to_text
    from verify.linear_stability import linear_stability

    found = linear_stability(scheme)
    if as_json:
        show.print_json(
            {
                "scheme": found.scheme,
                "interval": found.decimal(),
                "interval_exact": found.exact,
                "delta_j": to_text(found.delta_j),
            }
        )
        return
    shown = f"0 < hω ≤ {found.decimal(12)}"
    if found.interval.is_infinite or found.interval == 0:
        shown = "every hω > 0" if found.interval else "for no hω > 0"
    click.echo(f"{found.scheme} on the harmonic oscillator is stable {shown}")
    if found.interval.is_finite and not found.interval.is_rational:
        click.echo(f"  exactly  {found.exact}")
    click.echo(f"  ΔJ       {to_text(found.delta_j)}, y = hω")
