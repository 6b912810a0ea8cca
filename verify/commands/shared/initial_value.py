"""The options that say where a run starts, and the numbers in them."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from verify.hamiltonians.hamiltonian import Hamiltonian

_OPTIONS = (
    click.option(
        "--q",
        required=True,
        metavar="Q",
        help="Initial displacement; of q1, q2, … one each, as 0.1,0.2.",
    ),
    click.option("--p", required=True, metavar="P", help="Initial momentum; as --q."),
)


def start_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The command with --q and --p."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def listed(given: str, exact: "Hamiltonian") -> str | list[str]:
    """The number; of an H of p1 … qn a list, the numbers that commas part.

    Whoever takes them says so where there are too few or too many.
    """
    if exact.planar:
        return given
    return [part.strip() for part in given.split(",")]
