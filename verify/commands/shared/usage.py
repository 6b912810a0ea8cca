"""One-line messages for a command line that click refuses, with what to type instead."""

import re
import shlex
from collections.abc import Mapping, Sequence

import click

from verify.arithmetic.exact import as_whole
from verify.commands.shared.input import CatalogueName
from verify.errors import plain_name, unknown_name

# Names that other programs have for an option, by its name here.
_FOREIGN_OPTIONS = {
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
# Our command for a name that other programs have for it.
_FOREIGN_COMMANDS = {
    "help": "--help", "simulate": "run", "integrate": "run", "solve": "run", "compute": "run",
    "proof": "prove", "verify": "check", "test": "check", "list": "schemes", "method": "schemes",
    "methods": "schemes", "split": "separate", "benchmark": "bench", "plot": "report",
    # Commands of a group, which are often typed without it.
    "make": "reference", "compare": "reference", "export": "certificate",
}  # fmt: skip
_POWER_FORMULA = re.compile(r"[^=;]*\b[pq]\d*\*\*[^=;]*")  # text with a power of p or q


def explain_usage_mistake(error: click.ClickException, command_line: Sequence[str]) -> str:
    """Return one line for an error of click; `command_line`: the words after `verify`."""
    if match := re.match(r"Option '(.*?)' (requires|does not)", error.message):
        needs = (
            "has no value; write {} VALUE" if match[2] == "requires" else "takes no value; write {}"
        )
        return f"{match[1]}: {needs.format(match[1])}"
    context = getattr(error, "ctx", None)
    if context is None or not isinstance(error, click.UsageError):
        return error.format_message()
    message = error.message
    # By its name: older versions of click do not have the class.
    if type(error).__name__ == "NoArgsIsHelpError":
        commands_text = ", ".join(context.command.list_commands(context))
        return f"{context.command_path}: a command is missing; allowed: {commands_text}"
    if isinstance(error, click.NoSuchOption):
        return _explain_unknown_option(error.option_name, context, command_line)
    if isinstance(error, click.MissingParameter) and error.param is not None:
        return _explain_missing(error.param, context, command_line)
    if isinstance(error, click.BadParameter) and error.param is not None:
        return _explain_bad_value(error.param, message)
    if match := re.match(r"No such command '(.*?)'\.", message):
        names = context.command.list_commands(context)
        return str(unknown_name("command", match[1], names, aliases=_FOREIGN_COMMANDS))
    if match := re.match(r"Got unexpected extra arguments? \((.*)\)", message):
        # For words without their options the message has the corrected words, else only a hint.
        return _explain_bare_words(context, command_line) or _explain_extra_words(
            match[1], context, command_line
        )
    return f"{message} `{context.command_path} --help` lists what is allowed"


def _explain_unknown_option(name: str, context: click.Context, command_line: Sequence[str]) -> str:
    means_hamiltonian = name in ("-H", "--H")  # in lower case h is the step size
    if len(name) == 2:  # click takes -system for -s -y …
        name = next((x for x in command_line if x.startswith(name)), name).partition("=")[0]
    options = _option_names(context.command)
    plain = "hamiltonian" if means_hamiltonian else plain_name(name.lstrip("-"))
    aliases = {alias: ours for ours, foreign_names in _FOREIGN_OPTIONS.items() if ours in options
               for alias in foreign_names}  # fmt: skip
    spellings = {**aliases, **{option.lstrip("-"): option for option in options}}
    if plain in spellings:
        return f"{name}: no such option; write {spellings[plain]}"
    if elsewhere := _find_elsewhere(plain, context):
        return f"{name}: no such option here; it is one of {elsewhere}"
    from difflib import get_close_matches

    near = get_close_matches(plain, spellings, n=1, cutoff=0.6)
    if not near and "--param" in options:
        return f"{name}: no such option; a parameter of H is given as --param {plain}=VALUE"
    question = f"is {spellings[near[0]]} meant? " if near else ""
    return f"{name}: no such option; {question}allowed: {', '.join([*options, '--help'])}"


def _option_names(command: click.Command) -> list[str]:
    return [
        option
        for parameter in command.params
        for option in parameter.opts
        if option.startswith("-")
    ]


def _find_elsewhere(plain: str, context: click.Context) -> str:
    """Return the commands that have the option, under this name or one that other programs use."""
    ours = {
        f"--{plain}",
        *(name for name, foreign_names in _FOREIGN_OPTIONS.items() if plain in foreign_names),
    }
    return "" if context.parent is None else commands_with(ours, context)


def commands_with(names: set[str], context: click.Context, *, several: bool = False) -> str:
    """Return the commands with an option of these names; `several`: with a repeatable one."""
    command_names = [
        f"verify {command.name}"
        for command in _all_commands(context).values()
        for parameter in command.params
        if names & set(parameter.opts) and (getattr(parameter, "multiple", False) or not several)
    ]
    return ", ".join(dict.fromkeys(command_names))


def _all_commands(context: click.Context) -> Mapping[str, click.Command]:
    """Return the commands of the whole command line."""
    root = context.find_root().command
    assert isinstance(root, click.Group)  # noqa: S101 - no command is called without it
    return root.commands


def _explain_missing(
    parameter: click.Parameter, context: click.Context, command_line: Sequence[str]
) -> str:
    name = _shown_name(parameter)
    if name in command_line[1:]:  # click took it for the value of the option before it
        previous_option = command_line[command_line.index(name) - 1]
        usage = _usage_of(_find_option(previous_option, context))
        return f"{previous_option}={name}: has no value; write {usage}"
    if bare := _explain_bare_words(context, command_line):
        return bare
    if isinstance(parameter, click.Option):
        return f"{name}: is missing; write {_usage_of(parameter)}"
    return f"{name}: is missing; write {context.command_path} {name}"


def _explain_bad_value(parameter: click.Parameter, message: str) -> str:
    name, kind = _shown_name(parameter), parameter.type
    if match := re.match(r"'?(.*?)'? is not (a valid (integer|float)|in the range)", message, re.S):
        low, high = getattr(kind, "min", None), getattr(kind, "max", None)
        whole = isinstance(kind, click.types.IntParamType)
        range_text = (
            "" if low is None else f", {low} or more" if high is None else f", {low} … {high}"
        )
        must = f"must be a {'whole ' if whole else ''}number{range_text}"
        return f"{name}={match[1]}: {must}{as_whole(match[1], low or 1, high) if whole else ''}"
    if isinstance(kind, click.Choice):
        value = message.partition("'")[2].partition("'")[0]
        return str(unknown_name(name, value, list(map(str, kind.choices))))
    return f"{name}: {message}"


def _explain_bare_words(context: click.Context, command_line: Sequence[str]) -> str:
    """Return the message that adds the options missing before words; empty if one fits none."""
    command, typed_words = context.command, command_line[len(context.command_path.split()) - 1 :]
    _, words, typed_options = command.make_parser(context).parse_args(list(typed_words))
    suggestion = _add_options(words, command, typed_options)
    return f"{' '.join(words)}: not allowed here; write {suggestion}" if suggestion else ""


def _add_options(
    words: Sequence[str], command: click.Command, typed_options: Sequence[click.Parameter] = ()
) -> str:
    """Return each word after the option that takes it; empty if one fits none.

    `typed_options`: those that the command line already has.
    """
    unused = [(_shown_name(x), x.type) for x in command.params if x not in typed_options]
    fitting_options = [
        [name for name, kind in unused if isinstance(kind, CatalogueName) and kind.takes(word)]
        or [
            name for name, _ in unused if name == "--hamiltonian" and _POWER_FORMULA.fullmatch(word)
        ]
        for word in words
    ]
    pairs = zip(fitting_options, words, strict=True)
    return " ".join(f"{n[0]} {shlex.quote(x)}" for n, x in pairs) if all(fitting_options) else ""


def _explain_extra_words(extra: str, context: click.Context, command_line: Sequence[str]) -> str:
    index = next(
        (k for k, x in enumerate(command_line) if extra == x or extra.startswith(f"{x} ")), 0
    )
    option = _find_option(command_line[index - 2], context) if index >= 2 else None
    if isinstance(option, click.Option) and not option.is_flag:
        value = command_line[index - 1]
        if option.opts[0] == "--param":
            assignment = extra if "=" in extra else f"{value}={extra}"
            return f"{extra}: not allowed here; write --param {assignment}"
        repetition = f", and {option.opts[0]} again for another" if option.multiple else ""
        write = f"write a value with spaces in quotation marks{repetition}"
        return f"{extra}: not allowed here; {write}, and nothing without its option"
    arguments = [
        _shown_name(parameter)
        for parameter in context.command.params
        if isinstance(parameter, click.Argument)
    ]
    takes = " ".join([context.command_path, *arguments, "[OPTIONS]"])
    return f"{extra}: not allowed here; write {takes}"


def _find_option(name: str, context: click.Context) -> click.Parameter | None:
    return next((parameter for parameter in context.command.params if name in parameter.opts), None)


def _shown_name(parameter: click.Parameter) -> str:
    if isinstance(parameter, click.Option):
        # The long form: -o and --output are one option.
        return max(parameter.opts, key=len)
    return (parameter.metavar or parameter.name or "").strip("[]")


def _usage_of(parameter: click.Parameter | None) -> str:
    """Return the option with a placeholder for its value."""
    if parameter is None:
        return "a value"
    return f"{_shown_name(parameter)} {parameter.metavar or 'VALUE'}"
