"""The tally of verdicts and the failure of a check, which all commands of checks share."""

from collections import Counter
from collections.abc import Iterable

import click

from verify.prose import count

allow_undecided_option = click.option(
    "--allow-undecided", is_flag=True, help="Exit status 0 also where a claim is UNDECIDED."
)


def is_failure(verdicts: Iterable[str], *, allow_undecided: bool) -> bool:
    """Return True if a verdict is REFUTED, or UNDECIDED without --allow-undecided.

    `verdicts`: those of all requested claims. An undecided claim is not a pass: else a check could
    be passed by a claim that nothing decides.
    """
    return any(x == "REFUTED" or (x == "UNDECIDED" and not allow_undecided) for x in verdicts)


def print_tally(verdicts: Iterable[str]) -> None:
    """Print the number of claims of each verdict, the most frequent one first."""
    counts = Counter(map(str, verdicts))
    words = (f"{n} {word}" for word, n in counts.most_common())
    click.echo(f"{count(counts.total(), 'claim')}: {', '.join(words)}")
