"""How verdicts are counted, and when a check fails: what all commands of checks share."""

from collections import Counter
from collections.abc import Iterable

import click

from verify.prose import count

allow_undecided_option = click.option(
    "--allow-undecided", is_flag=True, help="Exit status 0 also where a claim is UNDECIDED."
)


def fails(verdicts: Iterable[str], *, allow_undecided: bool) -> bool:
    """True where a verdict is REFUTED, or UNDECIDED without --allow-undecided.

    `verdicts`: of all that is asked for; undecided is not a pass.
    """
    return any(x == "REFUTED" or (x == "UNDECIDED" and not allow_undecided) for x in verdicts)


def print_tally(verdicts: Iterable[str]) -> None:
    """How many claims have which verdict, the most frequent one first."""
    told = Counter(map(str, verdicts))
    words = (f"{n} {word}" for word, n in told.most_common())
    click.echo(f"{count(told.total(), 'claim')}: {', '.join(words)}")
