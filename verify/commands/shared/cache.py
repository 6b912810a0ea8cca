"""The option --no-cache of commands that compile kernels."""

import os

import click

from verify.code_cache import OFF, VARIABLE, folder


def _left_out(context: click.Context, _: click.Parameter, given: bool) -> None:
    """Sees to it that neither this process nor its workers look for kept kernels."""
    if context.resilient_parsing:  # a shell that completes the line
        return
    if not given:
        folder()  # a VERIFY_CACHE that is no folder's is refused before anything is computed
        return
    before = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = OFF
    context.call_on_close(lambda: os.environ.update({VARIABLE: before}))


cache_option = click.option(
    "--no-cache",
    is_flag=True,
    expose_value=False,
    callback=_left_out,
    help="Read H and compile every kernel anew, and keep nothing.",
)
