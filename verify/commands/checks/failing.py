"""When a check fails: one rule of exit statuses, which all commands of checks share."""

from collections.abc import Iterable

import click

allow_undecided_option = click.option(
    "--allow-undecided", is_flag=True, help="Exit status 0 also where a claim is UNDECIDED."
)


def fails(verdicts: Iterable[str], *, allow_undecided: bool) -> bool:
    """True where a verdict is REFUTED, or UNDECIDED without --allow-undecided.

    `verdicts`: of all that is asked for; undecided is not a pass.
    """
    return any(x == "REFUTED" or (x == "UNDECIDED" and not allow_undecided) for x in verdicts)
