"""A scene from options on the command line, for commands that otherwise take a file."""

import shlex
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.input import (
    SCENE,
    SCHEME,
    hamiltonian_of,
    hamiltonian_options,
    load_target,
    parse_coordinates,
)
from verify.commands.shared.option import option, options
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

_SYSTEM_OPTIONS = ("system", "hamiltonian", "params")
_REQUIRED_OPTIONS = ("schemes", "step_sizes")
schemes_option = option(
    "--scheme schemes",
    "NAME",
    "lie1, lie2, …, stormer-verlet, rk4, …, or 'p_next = …; q_next = …'; repeatable.",
    type=SCHEME,
    multiple=True,
)
start_options = options(
    option("--q", "Q", "Initial displacement."), option("--p", "P", "Initial momentum.")
)
_step_options = options(
    option(
        "--step-size step_sizes", "H", "The step size, greater than 0; repeatable.", multiple=True
    ),
    option("--t0", "T0", "The start time, if the Hamiltonian depends on t.  [default: 0]"),
)


def with_one_line(*extra_options: Callable[..., Any]) -> Callable[..., Any]:
    """Return a decorator for commands that take SCENE, or options in its place.

    The options are those of the system, of schemes and step sizes, and `extra_options`. The command
    gets them as keyword arguments, which `scenes_of` takes.
    """

    def add_options(command: Callable[..., Any]) -> Callable[..., Any]:
        command = schemes_option(_step_options(options(*extra_options)(command)))
        argument = click.argument("scene", type=SCENE, required=False, metavar="[SCENE]")
        return argument(hamiltonian_options(command))

    return add_options


def scenes_of(
    scene: str | None,
    values: Mapping[str, Any],
    required: tuple[str, ...],
    sections: Callable[..., Mapping[str, Any]],
) -> "list[Scene]":
    """Return the scenes that SCENE names, or one scene that the options in `values` describe.

    `required`: the options that must be given, besides schemes and step sizes. `sections` builds
    the scene's sections from all options but those of the system and the schemes. Raises InputError
    if both SCENE and options are given, or neither, or if a required option is missing.
    """
    if scene is not None:
        check_scene_alone(values)
        return load_target(scene)[1]
    requested = _requested_options(values)
    if not requested:
        raise InputError(
            "SCENE", NOT_GIVEN, "is missing; or give --system, --scheme, --step-size, …"
        )
    hamiltonian = hamiltonian_of(*(values[name] for name in _SYSTEM_OPTIONS))
    for name in (*_REQUIRED_OPTIONS, *required):
        if name not in requested:
            raise InputError(name, NOT_GIVEN, "is missing")
    from verify.calls.inputs import scene_of

    section_values = {
        n: x for n, x in requested.items() if n not in (*_SYSTEM_OPTIONS, "schemes", "t0")
    }
    section_values |= {
        n: parse_coordinates(section_values[n], hamiltonian)
        for n in ("q", "p")
        if n in section_values
    }
    name = values["system"] or hamiltonian.formula
    built_scene = scene_of(
        hamiltonian, requested["schemes"], None, t0=requested.get("t0"), name=name,
        system_name=values["system"], **sections(**section_values),
    )  # fmt: skip
    return [built_scene]


def check_scene_alone(values: Mapping[str, Any]) -> None:
    """Raise InputError if one of these options is given together with SCENE."""
    for name, x in _requested_options(values).items():
        raise InputError(name, x[0] if isinstance(x, tuple) else x, "goes without SCENE")


def _requested_options(values: Mapping[str, Any]) -> dict[str, Any]:
    # None and False by identity: a typed 0 equals False, and must not be left out.
    return {n: x for n, x in values.items() if not (x is None or x is False or x == ())}


def line_of(values: Mapping[str, Any]) -> str:
    """Return the typed options as text that a shell splits into the same words."""
    context, parts = click.get_current_context(), []
    for parameter in context.command.params:
        x = values.get(parameter.name or "")
        for value in x if isinstance(x, tuple) else (x,):
            if value not in (None, False):
                parts += [parameter.opts[-1], str(value)]
    return shlex.join(parts)
