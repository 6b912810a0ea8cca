"""Options that commands share, and the objects that they name."""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.option import flag, option, options
from verify.content import content
from verify.errors import NOT_GIVEN, InputError, plain_name, unknown_name

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from verify.claims.claims_file import ClaimsFile
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.scene import Scene


class NonemptyPath(click.Path):
    """The type of a path; an empty text is refused, and is not the current folder."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        if not str(value).strip():
            self.fail("is empty; give a path", param, ctx)
        return super().convert(value, param, ctx)


class CatalogueName(click.ParamType[str]):
    """The type of a name of a catalogue, in any case or an alias; a shell completes it."""

    def __init__(self, name: str, catalogue: Callable[[], Any]) -> None:
        self.name, self.catalogue = name, catalogue

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        return self.catalogue().canonical(str(value))

    def takes(self, value: str) -> bool:
        """Return True if the catalogue has the name."""
        try:
            return bool(self.catalogue().get(value))
        except InputError:
            return False

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> "list[CompletionItem]":
        from click.shell_completion import CompletionItem

        catalogue, beginning = self.catalogue(), plain_name(incomplete)
        matches = [name for name in catalogue.names() if name.startswith(beginning)]
        if not matches:
            aliases: Iterable[str] = getattr(catalogue, "aliases", tuple)()
            matches = [name for name in aliases if name.startswith(beginning)]
        return [CompletionItem(name) for name in matches]


class _SchemeName(CatalogueName):
    """The type of a scheme: a name, formulas, coefficients, or a TOML file with one table."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        if str(value).strip().endswith(".toml"):
            from verify.integrators.tables.table_scheme import scheme_from_file

            return scheme_from_file(Path(value.strip()))
        return super().convert(value, param, ctx)


class _FileOr(click.ParamType[str]):
    """The type of a file, or of one of these names; a shell completes both."""

    name = "file"

    def __init__(self, names: Callable[[], Iterable[str]]) -> None:
        self.names = names

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> "list[CompletionItem]":
        from click.shell_completion import CompletionItem

        items = [CompletionItem(name) for name in self.names() if name.startswith(incomplete)]
        return [*items, CompletionItem(incomplete, type="file")]


def _schemes() -> Any:
    from verify import schemes

    return schemes


def _systems() -> Any:
    from verify.hamiltonians import systems

    return systems


PATH = NonemptyPath(path_type=Path)
SCENE = _FileOr(lambda: ("paper", *suites()))
CLAIMS = _FileOr(lambda: ("paper",))
FILE = _FileOr(tuple)
SCHEME = _SchemeName("scheme", _schemes)
_SYSTEM = CatalogueName("system", _systems)


# The options that name a Hamiltonian, arguments of `hamiltonian_of`.
hamiltonian_options = options(
    option(
        "--system",
        "NAME",
        "A named system, such as duffing; `verify systems` lists them.",
        type=_SYSTEM,
    ),
    option("--hamiltonian", "TEXT", "H(p, q), such as 'p**2/2 - cos(q)'."),
    option("--param params", "NAME=VALUE", "A parameter's exact value; repeatable.", multiple=True),
)
# The same, or equations without an H.
system_options = options(
    hamiltonian_options,
    option(
        "--field", "TEXT", "Equations without an H, such as 'u_dot = u*(v - 2); v_dot = v*(1 - u)'."
    ),
)
scheme_option = option(
    "--scheme",
    "NAME",
    "lie1, lie2, …, stormer-verlet, rk4, gauss4, …: `verify schemes` lists them; or"
    " 'p_next = …; q_next = …'.",
    type=SCHEME,
    required=True,
)

every_options = options(
    flag(
        "--every-hamiltonian",
        "For every smooth H, its derivatives as free variables, instead of one.",
    ),
    flag("--separable", "With --every-hamiltonian: for every H = T(p) + V(q)."),
)
start_options = options(
    option("--q", "Q", "Initial displacement; of q1, q2, … one each, as 0.1,0.2.", required=True),
    option("--p", "P", "Initial momentum; as --q.", required=True),
)
time_limit_option = option(
    "--time-limit",
    "SECONDS",
    "For all calls of the function.",
    type=click.FloatRange(0.01),
    default=60.0,
)


def with_hamiltonian(
    command: Callable[..., Any], *, use_cache: bool = False, takes_field: bool = False
) -> Callable[..., Any]:
    """Add the options of a Hamiltonian to a command, which gets it as the argument `hamiltonian`.

    `use_cache`: it may come from the cache, for a command with --no-cache that needs no sympy.
    `takes_field`: it may be equations.
    """

    @wraps(command)
    def wrapper(
        *args: Any,
        system: str | None,
        hamiltonian: str | None,
        params: tuple[str, ...],
        field: str | None = None,
        **options: Any,
    ) -> Any:
        parsed = hamiltonian_of(system, hamiltonian, params, field, use_cache=use_cache)
        return command(*args, hamiltonian=parsed, **options)

    return (system_options if takes_field else hamiltonian_options)(wrapper)


with_kept_hamiltonian = partial(with_hamiltonian, use_cache=True)
with_kept_system = partial(with_hamiltonian, use_cache=True, takes_field=True)


def values_of(params: tuple[str, ...], option: str = "--param") -> dict[str, str]:
    """Return the values of NAME=VALUE by their names. Raises InputError."""
    values: dict[str, str] = {}
    for text in params:
        name, equals, value = text.partition("=")
        if not equals:
            raise InputError(option, text, "has no value; write NAME=VALUE, or leave it out")
        if name in values:
            raise InputError(option, text, f"{name} is given twice")
        # Several parameters in one option, as a=1,b=2: the error shows how to write them.
        if "=" in value and re.search("[,;]", value):
            instead = " --param ".join(part.strip() for part in re.split("[,;]", text))
            raise InputError("--param", text, f"is more than one; write --param {instead}")
        values[name.strip()] = value
    return values


def hamiltonian_of(
    system: str | None,
    hamiltonian: str | None,
    params: tuple[str, ...],
    field: str | None = None,
    *,
    use_cache: bool = False,
) -> "Hamiltonian":
    """Return the Hamiltonian that the options name; InputError unless they name one.

    `field`: equations, for a command that takes them.
    """
    from verify.hamiltonians import systems
    from verify.hamiltonians.hamiltonian import Hamiltonian

    if field is not None and system is None and hamiltonian is None:
        from verify.hamiltonians.equations import EXAMPLE, are_equations, read_system

        if not are_equations(field):
            raise InputError("--field", field, f"has no equation; write {EXAMPLE}")
        return read_system(field, values_of(params))
    if (system is None) == (hamiltonian is None) or field is not None:
        raise InputError("--system, --hamiltonian", system or NOT_GIVEN, "give one of the two")
    values = values_of(params)
    if system is not None:
        source, reader = f"system {system}", systems.get(system).hamiltonian
    else:
        systems.check_is_formula(hamiltonian or "")
        source, reader = f"formula {hamiltonian}", partial(Hamiltonian.parse, hamiltonian or "")
    if not use_cache:
        return reader(values)
    from verify.hamiltonians.hamiltonian_store import load_or_read

    return load_or_read(source, values, reader)


def one_or_every(
    every: bool, named_options: Mapping[str, Any], **options_of_every: Any
) -> "Hamiltonian | None":
    """Return the H that the options name; None if the command is for every H.

    Raises InputError if options name an H and `every` is set, and if one of `options_of_every`,
    which go with `every`, is used for a single H.
    """
    if every:
        if any(value not in (None, ()) for value in named_options.values()):
            problem = "goes without --system, --hamiltonian, --param"
            raise InputError("every_hamiltonian", NOT_GIVEN, problem)
        return None
    for name, value in options_of_every.items():
        if value:
            raise InputError(name, NOT_GIVEN, "goes with --every-hamiltonian")
    return hamiltonian_of(**named_options)


def parse_coordinates(text: str, hamiltonian: "Hamiltonian") -> str | list[str]:
    """Return the number; for an H of p1 … qn a list of numbers that commas separate.

    Their count is checked by the caller.
    """
    if hamiltonian.planar:
        return text
    return [part.strip() for part in text.split(",")]


def paper_folder() -> Path:
    """Return the folder of the paper's scenes and claims."""
    return content("reports", "paper")


def load_target(scene: str, *further_names: str) -> "tuple[str, list[Scene], ClaimsFile | None]":
    """Load the title, scenes and claims of `paper`, of a suite, of a scene's or a claims file.

    `further_names`: further names that the command takes, which the error for an unknown one lists.
    """
    from verify.scenes.scene import load_scene
    from verify.scenes.toml_file import read_toml

    if scene in suites():
        return suites()[scene], _load_suite(scene), None
    path = Path(scene)
    if scene == "paper":
        path = paper_folder() / "claims.toml"
    else:
        if not scene.strip():
            raise InputError("SCENE", scene, "is empty; give paper, a suite or a TOML file")
        # A bare word without a file is a mistyped name rather than a missing file.
        if not path.suffix and not path.exists():
            here = {path.stem: path.name for path in sorted(Path.cwd().glob("*.toml"))}
            names = ("paper", *suites(), *further_names)
            raise unknown_name("SCENE", scene, names, ", or a TOML file", here)
    if "claim" not in read_toml(path):
        loaded = load_scene(path)
        return loaded.title or loaded.name, [loaded], None
    from verify.claims.claims_file import load_claims

    file = load_claims(path)
    return file.title, file.report_scenes, file


def suites() -> dict[str, str]:
    """Return the title of each suite, read from a file in its folder."""
    titles = sorted(content("reports", "suites").glob("*/title.txt"))
    return {title.parent.name: title.read_text("utf-8").strip() for title in titles}


def _load_suite(name: str) -> "list[Scene]":
    from verify.scenes.scene import load_scene

    return [load_scene(path) for path in sorted(content("reports", "suites", name).glob("*.toml"))]
