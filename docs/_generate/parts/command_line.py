"""Every command with its usage, its options and their help, as `--help` has them."""

import inspect
from collections.abc import Iterator

import click

from docs._generate.commands import contexts
from docs._generate.markdown import code, codes, prose, table

_VERBATIM = "\b"  # click leaves the paragraph after it as it is


def text() -> str:
    """A section for each command."""
    return "\n\n".join("\n\n".join(_section(context)) for context in contexts()) + "\n"


def _section(context: click.Context) -> Iterator[str]:
    command = context.command
    yield f"### {context.command_path}"
    usage = " ".join([context.command_path, *command.collect_usage_pieces(context)])
    yield f"```text\n{usage}\n```"
    for paragraph in inspect.cleandoc(command.help or "").split("\n\n"):
        yield _shown(paragraph)
    records = [found for p in command.get_params(context) if (found := p.get_help_record(context))]
    if records:
        yield table(("option", "does"), ((_names(name), prose(does)) for name, does in records))


def _shown(paragraph: str) -> str:
    if not paragraph.startswith(_VERBATIM):
        return prose(paragraph)
    lines = paragraph.removeprefix(_VERBATIM).strip("\n")
    return f"```text\n{lines}\n```"


def _names(record: str) -> str:
    """`-o, --output DIR` of help, each name as code."""
    return codes(record.split(", ")) if not record.startswith("[") else code(record)
