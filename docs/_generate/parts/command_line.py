"""Every command with its usage, its options and their help, as `--help` has them."""

import inspect
from collections.abc import Iterable, Iterator
from itertools import groupby

import click

from docs._generate.commands import contexts
from docs._generate.markdown import codes, prose, table

_VERBATIM = "\b"  # click leaves the paragraph after it as it is


def text() -> str:
    """A section for each command."""
    return "\n\n".join("\n\n".join(_section(context)) for context in contexts()) + "\n"


def _section(context: click.Context) -> Iterator[str]:
    command = context.command
    yield f"### {context.command_path}"
    usage = " ".join([context.command_path, *command.collect_usage_pieces(context)])
    yield f"```text\n{usage}\n```"
    paragraphs = inspect.cleandoc(command.help or "").split("\n\n")
    for verbatim, together in groupby(paragraphs, lambda text: text.startswith(_VERBATIM)):
        yield (_block if verbatim else _sentences)(together)
    options = (p for p in command.get_params(context) if isinstance(p, click.Option))
    records = [found for p in options if (found := p.get_help_record(context))]
    yield table(("option", "does"), ((_names(name), prose(does)) for name, does in records))


def _sentences(paragraphs: Iterable[str]) -> str:
    return "\n\n".join(map(prose, paragraphs))


def _block(paragraphs: Iterable[str]) -> str:
    """What help leaves as it is, such as examples."""
    lines = "\n\n".join(each.removeprefix(_VERBATIM).strip("\n") for each in paragraphs)
    return f"```text\n{lines}\n```"


def _names(record: str) -> str:
    """`-o, --output DIR` of help, each name as code."""
    return codes(record.split(", "))
