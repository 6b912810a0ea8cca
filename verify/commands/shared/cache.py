"""The option --no-cache of commands that compile kernels."""

import os

import click

from verify.code_cache import OFF, VARIABLE, folder


def _disable_cache(context: click.Context, _: click.Parameter, is_set: bool) -> None:
    """Make this process and its workers look for no kept kernels."""
    if context.resilient_parsing:  # a shell that completes the line
        return
    if not is_set:
        folder()  # a VERIFY_CACHE that is no folder's is refused before anything is computed
        return
    # Workers inherit the environment; the variable is put back, as tests run several commands.
    before = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = OFF
    context.call_on_close(lambda: os.environ.update({VARIABLE: before}))


cache_option = click.option(
    "--no-cache",
    is_flag=True,
    expose_value=False,
    callback=_disable_cache,
    help="Read H and compile every kernel anew, and keep nothing.",
)
