"""A scene in one line: the options of commands that otherwise take a file."""

import shlex
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.input import (
    SCENE,
    SCHEME,
    hamiltonian_of,
    hamiltonian_options,
    listed,
    options,
    target,
)
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

_SYSTEM = ("system", "hamiltonian", "params")
_NEEDED = ("schemes", "step_sizes")
schemes_option = click.option(
    "--scheme",
    "schemes",
    type=SCHEME,
    multiple=True,
    metavar="NAME",
    help="lie1, lie2, …, stormer-verlet, rk4, …, or 'p_next = …; q_next = …'; repeatable.",
)
start_options = options(
    click.option("--q", metavar="Q", help="Initial displacement."),
    click.option("--p", metavar="P", help="Initial momentum."),
)
_STEPS = options(
    click.option(
        "--step-size", "step_sizes", multiple=True, metavar="H", help="Greater than 0; repeatable."
    ),
    click.option("--t0", metavar="T", help="When it starts, of an H(p, q, t).  [default: 0]"),
)


def with_one_line(*own: Callable[..., Any]) -> Callable[..., Any]:
    """Makes a command take SCENE, or these options in its place: which system, schemes and step
    sizes, and those of its own. It gets them as keyword arguments that `scenes_of` takes.
    """

    def decorated(command: Callable[..., Any]) -> Callable[..., Any]:
        command = schemes_option(_STEPS(options(*own)(command)))
        argument = click.argument("scene", type=SCENE, required=False, metavar="[SCENE]")
        return argument(hamiltonian_options(command))

    return decorated


def scenes_of(
    scene: str | None,
    given: Mapping[str, Any],
    needed: tuple[str, ...],
    sections: Callable[..., Mapping[str, Any]],
) -> "list[Scene]":
    """The scenes of SCENE, or the one that the options in `given` are.

    `needed`: which of them cannot be left out, beside schemes and step sizes. `sections` makes the
    scene's sections of those that are not the system's nor the schemes. InputError where both are
    given, or neither, or one is missing.
    """
    if scene is not None:
        goes_alone(given)
        return target(scene)[1]
    asked = _asked(given)
    if not asked:
        raise InputError(
            "SCENE", NOT_GIVEN, "is missing; or give --system, --scheme, --step-size, …"
        )
    exact = hamiltonian_of(*(given[name] for name in _SYSTEM))
    for name in (*_NEEDED, *needed):
        if name not in asked:
            raise InputError(name, NOT_GIVEN, "is missing")
    from verify.calls.given import scene_of

    own = {n: x for n, x in asked.items() if n not in (*_SYSTEM, "schemes", "t0")}
    own |= {n: listed(own[n], exact) for n in ("q", "p") if n in own}
    name = given["system"] or exact.formula
    made = scene_of(
        exact, asked["schemes"], None, t0=asked.get("t0"), name=name, known_as=given["system"],
        **sections(**own),
    )  # fmt: skip
    return [made]


def goes_alone(given: Mapping[str, Any]) -> None:
    """InputError where SCENE is given, and one of these options too."""
    for name, x in _asked(given).items():
        raise InputError(name, x[0] if isinstance(x, tuple) else x, "goes without SCENE")


def _asked(given: Mapping[str, Any]) -> dict[str, Any]:
    # By identity: 0 == False, and a 0 that is typed is refused, not left out.
    return {n: x for n, x in given.items() if not (x is None or x is False or x == ())}


def line_of(given: Mapping[str, Any]) -> str:
    """Those of the options that were typed, as a shell reads them again."""
    context, parts = click.get_current_context(), []
    for option in context.command.params:
        x = given.get(option.name or "")
        for value in x if isinstance(x, tuple) else (x,):
            if value not in (None, False):
                parts += [option.opts[-1], str(value)]
    return shlex.join(parts)
