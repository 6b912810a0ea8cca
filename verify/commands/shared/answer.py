"""What a command answers: told as JSON or as text, and with the exit status that it asks for."""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any

import click

from verify.errors import InputError

FAILED = 1  # exit status


@dataclass(frozen=True)
class Answer:
    """`data` as JSON, `show` prints it for people; only the one that is asked for is called.

    `failed`: a check did. `problem`: what went wrong besides; it is raised once all is told.
    """

    data: Callable[[], dict[str, Any]]
    show: Callable[[], None]
    failed: bool = False
    problem: InputError | None = None


def answering(command: Callable[..., Answer]) -> Callable[..., None]:
    """The command with --json; its answer is told, and ends it with its exit status."""

    @wraps(command)
    def told(*args: Any, as_json: bool, **options: Any) -> None:
        answer = command(*args, **options)
        if as_json:
            encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
            ascii_only = encoding.lower().replace("-", "") != "utf8"
            click.echo(json.dumps(answer.data(), ensure_ascii=ascii_only))
        else:
            answer.show()
        if answer.problem is not None:
            raise answer.problem
        if answer.failed:
            raise SystemExit(FAILED)

    return click.option(
        "--json", "as_json", is_flag=True, help="One JSON object on standard output."
    )(told)


def picked(found: object, *names: str) -> dict[str, Any]:
    """What `found` calls by these names, under the same names."""
    return {name: getattr(found, name) for name in names}
