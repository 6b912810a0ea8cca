"""A command line that click refuses, in one line: what was typed, and what to type instead."""

import re
import shlex
from collections.abc import Sequence

import click

from verify.arithmetic.exact import as_whole
from verify.commands import Commands
from verify.commands.shared.input import Named
from verify.errors import plain_name, unknown

# What others call an option, by what it is called here.
_OPTIONS = {
    "--step-size": ("h", "dt", "step", "stepsize", "delta-t", "tau", "timestep", "time-step"),
    "--steps": ("n", "nsteps", "n-steps", "num-steps", "iterations"),
    "--time": ("t", "tmax", "t-max", "tend", "t-end", "tf", "duration", "total-time"),
    "--q": ("x", "x0", "q0", "position"),
    "--p": ("v", "v0", "p0", "velocity", "momentum"),
    "--scheme": ("method", "integrator", "solver", "schemes"),
    "--digits": ("precision", "prec", "dps"),
    "--param": ("params", "parameter", "parameters"),
    "--output": ("o", "out", "outdir", "output-dir"),
    "--csv": ("o", "out", "output", "file"),
    "--maximise": ("maximize",),
}
_COMMANDS = {
    "help": "--help", "simulate": "run", "integrate": "run", "solve": "run", "compute": "run",
    "proof": "prove", "verify": "check", "test": "check", "list": "schemes", "method": "schemes",
    "methods": "schemes", "split": "separate", "benchmark": "bench", "plot": "report",
    "make": "reference", "compare": "reference", "export": "certificate",
}  # fmt: skip
_FORMULA = re.compile(r"[^=;]*\b[pq]\d*\*\*[^=;]*")  # with a power of p or q


def usage_mistake(error: click.ClickException, typed: Sequence[str]) -> str:
    """The one line for an error of click's; `typed`: the arguments of the command line."""
    if found := re.match(r"Option '(.*?)' (requires|does not)", error.message):
        needs = (
            "has no value; write {} VALUE" if found[2] == "requires" else "takes no value; write {}"
        )
        return f"{found[1]}: {needs.format(found[1])}"
    context = getattr(error, "ctx", None)
    if context is None or not isinstance(error, click.UsageError):
        return error.format_message()
    message = error.message
    if type(error).__name__ == "NoArgsIsHelpError":
        listed = ", ".join(context.command.list_commands(context))
        return f"{context.command_path}: a command is missing; allowed: {listed}"
    if isinstance(error, click.NoSuchOption):
        return _no_such_option(error.option_name, context, typed)
    if isinstance(error, click.MissingParameter) and error.param is not None:
        return _missing(error.param, context, typed)
    if isinstance(error, click.BadParameter) and error.param is not None:
        return _bad_value(error.param, message)
    if found := re.match(r"No such command '(.*?)'\.", message):
        names = context.command.list_commands(context)
        return str(unknown("command", found[1], names, aliases=_COMMANDS))
    if found := re.match(r"Got unexpected extra arguments? \((.*)\)", message):
        return _bare_words(context, typed) or _too_much(found[1], context, typed)
    return f"{message} `{context.command_path} --help` lists what is allowed"


def _no_such_option(name: str, context: click.Context, typed: Sequence[str]) -> str:
    capital = name in ("-H", "--H")  # the Hamiltonian's letter; h is a step size
    if len(name) == 2:  # click takes -system for -s -y …
        name = next((x for x in typed if x.startswith(name)), name).partition("=")[0]
    allowed = _options(context.command)
    plain = "hamiltonian" if capital else plain_name(name.lstrip("-"))
    aliases = {other: ours for ours, others in _OPTIONS.items() if ours in allowed
               for other in others}  # fmt: skip
    known = {**aliases, **{option.lstrip("-"): option for option in allowed}}
    if plain in known:
        return f"{name}: no such option; write {known[plain]}"
    if elsewhere := _elsewhere(plain, context):
        return f"{name}: no such option here; it is one of {elsewhere}"
    from difflib import get_close_matches

    near = get_close_matches(plain, known, n=1, cutoff=0.6)
    if not near and "--param" in allowed:
        return f"{name}: no such option; a parameter of H is given as --param {plain}=VALUE"
    asked = f"is {known[near[0]]} meant? " if near else ""
    return f"{name}: no such option; {asked}allowed: {', '.join([*allowed, '--help'])}"


def _options(command: click.Command) -> list[str]:
    return [option for each in command.params for option in each.opts if option.startswith("-")]


def _elsewhere(plain: str, context: click.Context) -> str:
    """The other commands that have the option, under its name or another that it goes by."""
    ours = {f"--{plain}", *(name for name, others in _OPTIONS.items() if plain in others)}
    return "" if context.parent is None else commands_with(ours)


def commands_with(names: set[str], *, several: bool = False) -> str:
    """The commands that have an option of these names; `several`: that may stand several times."""
    having = [
        f"verify {command.name}"
        for command in Commands().values()
        for each in command.params
        if names & set(each.opts) and (getattr(each, "multiple", False) or not several)
    ]
    return ", ".join(dict.fromkeys(having))


def _missing(parameter: click.Parameter, context: click.Context, typed: Sequence[str]) -> str:
    name = _name(parameter)
    if name in typed[1:]:  # it was taken for the value of the option before it
        before = typed[typed.index(name) - 1]
        return f"{before}={name}: has no value; write {_written(_option(before, context))}"
    if bare := _bare_words(context, typed):
        return bare
    if isinstance(parameter, click.Option):
        return f"{name}: is missing; write {_written(parameter)}"
    return f"{name}: is missing; write {context.command_path} {name}"


def _bad_value(parameter: click.Parameter, message: str) -> str:
    name, kind = _name(parameter), parameter.type
    if found := re.match(r"'?(.*?)'? is not (a valid (integer|float)|in the range)", message, re.S):
        low, high = getattr(kind, "min", None), getattr(kind, "max", None)
        whole = isinstance(kind, click.types.IntParamType)
        allowed = "" if low is None else f", {low} or more" if high is None else f", {low} … {high}"
        must = f"must be a {'whole ' if whole else ''}number{allowed}"
        return f"{name}={found[1]}: {must}{as_whole(found[1], low or 1, high) if whole else ''}"
    if isinstance(kind, click.Choice):
        value = message.partition("'")[2].partition("'")[0]
        return str(unknown(name, value, list(map(str, kind.choices))))
    return f"{name}: {message}"


def _bare_words(context: click.Context, typed: Sequence[str]) -> str:
    """The mistake of words without their options, which it writes before them; else empty."""
    command, rest = context.command, typed[len(context.command_path.split()) - 1 :]
    _, words, order = command.make_parser(context).parse_args(list(rest))
    written = _with_options(words, command, order)
    return f"{' '.join(words)}: not allowed here; write {written}" if written else ""


def _with_options(
    words: Sequence[str], command: click.Command, order: Sequence[click.Parameter] = ()
) -> str:
    """Each word after the option that takes it; empty where one fits none.

    `order`: the options that the command line has already.
    """
    free = [(_name(x), x.type) for x in command.params if x not in order]
    fits = [
        [name for name, kind in free if isinstance(kind, Named) and kind.takes(word)]
        or [name for name, _ in free if name == "--hamiltonian" and _FORMULA.fullmatch(word)]
        for word in words
    ]
    pairs = zip(fits, words, strict=True)
    return " ".join(f"{n[0]} {shlex.quote(x)}" for n, x in pairs) if all(fits) else ""


def _too_much(extra: str, context: click.Context, typed: Sequence[str]) -> str:
    at = next((k for k, x in enumerate(typed) if extra == x or extra.startswith(f"{x} ")), 0)
    option = _option(typed[at - 2], context) if at >= 2 else None
    if isinstance(option, click.Option) and not option.is_flag:
        value = typed[at - 1]
        if option.opts[0] == "--param":
            meant = extra if "=" in extra else f"{value}={extra}"
            return f"{extra}: not allowed here; write --param {meant}"
        again = f", and {option.opts[0]} again for another" if option.multiple else ""
        write = f"write a value with spaces in quotation marks{again}"
        return f"{extra}: not allowed here; {write}, and nothing without its option"
    arguments = [_name(each) for each in context.command.params if isinstance(each, click.Argument)]
    takes = " ".join([context.command_path, *arguments, "[OPTIONS]"])
    about = "" if arguments else _with_options([extra], Commands()["prove"])
    takes += about and f" for all of them, or verify prove {about} … for this one"
    return f"{extra}: not allowed here; write {takes}"


def _option(name: str, context: click.Context) -> click.Parameter | None:
    return next((each for each in context.command.params if name in each.opts), None)


def _name(parameter: click.Parameter) -> str:
    if isinstance(parameter, click.Option):
        return max(parameter.opts, key=len)
    return (parameter.metavar or parameter.name or "").strip("[]")


def _written(parameter: click.Parameter | None) -> str:
    """The option with what stands for its value."""
    if parameter is None:
        return "a value"
    return f"{_name(parameter)} {parameter.metavar or 'VALUE'}"
