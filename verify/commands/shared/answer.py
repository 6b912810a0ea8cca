"""The answer of a command: printed as JSON or as text, with its exit status."""

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
    """An answer: `data` returns it as JSON, `show` prints it for people; only one is called.

    `failed`: a check failed. `problem`: another error, which is raised after the output.
    """

    data: Callable[[], dict[str, Any]]
    show: Callable[[], None]
    failed: bool = False
    problem: InputError | None = None


def answering(command: Callable[..., Answer]) -> Callable[..., None]:
    """Add --json to a command, print its answer, and exit with the answer's status."""

    @wraps(command)
    def wrapper(*args: Any, as_json: bool, **options: Any) -> None:
        answer = command(*args, **options)
        if as_json:
            encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
            # A terminal of another encoding gets escapes, which mean the same in JSON.
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
    )(wrapper)


def pick(source: object, *names: str) -> dict[str, Any]:
    """Return the attributes of `source` with these names, by the same names."""
    return {name: getattr(source, name) for name in names}
