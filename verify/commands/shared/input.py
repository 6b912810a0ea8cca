"""Options that commands share, and what they stand for."""

import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.content import content
from verify.errors import NOT_GIVEN, InputError, plain_name, unknown

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from verify.claims.file import ClaimsFile
    from verify.hamiltonians.hamiltonian import Hamiltonian
    from verify.scenes.scene import Scene


class GivenPath(click.Path):
    """A path; an empty text is none, and not the current folder."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        if not str(value).strip():
            self.fail("is empty; give a path", param, ctx)
        return super().convert(value, param, ctx)


class Named(click.ParamType[str]):
    """A name of a catalogue, in any case or an alias; a shell completes it."""

    def __init__(self, name: str, catalogue: Callable[[], Any]) -> None:
        self.name, self.catalogue = name, catalogue

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        return self.catalogue().canonical(str(value))

    def takes(self, value: str) -> bool:
        """True where the catalogue has it."""
        try:
            return bool(self.catalogue().get(value))
        except InputError:
            return False

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> "list[CompletionItem]":
        from click.shell_completion import CompletionItem

        catalogue, begun = self.catalogue(), plain_name(incomplete)
        found = [name for name in catalogue.names() if name.startswith(begun)]
        if not found:
            aliases: Iterable[str] = getattr(catalogue, "aliases", tuple)()
            found = [name for name in aliases if name.startswith(begun)]
        return [CompletionItem(name) for name in found]


class _FileOr(click.ParamType[str]):
    """A file, or one of these names; a shell completes both."""

    name = "file"

    def __init__(self, names: Callable[[], Iterable[str]]) -> None:
        self.names = names

    def shell_complete(self, ctx: Any, param: Any, incomplete: str) -> "list[CompletionItem]":
        from click.shell_completion import CompletionItem

        found = [CompletionItem(name) for name in self.names() if name.startswith(incomplete)]
        return [*found, CompletionItem(incomplete, type="file")]


def _schemes() -> Any:
    from verify import schemes

    return schemes


def _systems() -> Any:
    from verify.hamiltonians import systems

    return systems


PATH = GivenPath(path_type=Path)
SCENE = _FileOr(lambda: ("paper", *suites()))
CLAIMS = _FileOr(lambda: ("paper",))
FILE = _FileOr(tuple)
SCHEME = Named("scheme", _schemes)
_SYSTEM = Named("system", _systems)
Command = Callable[..., Any]


def options(*given: Callable[[Command], Command]) -> Callable[[Command], Command]:
    """Makes a command take these options, which its help lists in this order."""

    def with_options(command: Command) -> Command:
        for option in reversed(given):
            command = option(command)
        return command

    return with_options


# Those that name a Hamiltonian, which `hamiltonian_of` takes.
hamiltonian_options = options(
    click.option(
        "--system",
        type=_SYSTEM,
        metavar="NAME",
        help="A named system, such as duffing; `verify systems` lists them.",
    ),
    click.option("--hamiltonian", metavar="TEXT", help="H(p, q), such as 'p**2/2 - cos(q)'."),
    click.option(
        "--param",
        "params",
        multiple=True,
        metavar="NAME=VALUE",
        help="A parameter's exact value; repeatable.",
    ),
)
scheme_option = click.option(
    "--scheme",
    type=SCHEME,
    metavar="NAME",
    required=True,
    help="lie1, lie2, …, stormer-verlet, rk4, gauss4, …: `verify schemes` lists them; or"
    " 'p_next = …; q_next = …'.",
)

every_options = options(
    click.option(
        "--every-hamiltonian",
        is_flag=True,
        help="For every smooth H, its derivatives as free variables, instead of one.",
    ),
    click.option(
        "--separable", is_flag=True, help="With --every-hamiltonian: for every H = T(p) + V(q)."
    ),
)
start_options = options(
    click.option(
        "--q",
        required=True,
        metavar="Q",
        help="Initial displacement; of q1, q2, … one each, as 0.1,0.2.",
    ),
    click.option("--p", required=True, metavar="P", help="Initial momentum; as --q."),
)
time_limit_option = click.option(
    "--time-limit",
    type=click.FloatRange(0.01),
    default=60.0,
    metavar="SECONDS",
    help="For all calls of the function.",
)


def with_hamiltonian(command: Callable[..., Any], *, kept: bool = False) -> Callable[..., Any]:
    """The command with these options, which it gets as one Hamiltonian, `exact`.

    `kept`: as it was kept, where it was; for a command with --no-cache, and no need of sympy.
    """

    @wraps(command)
    def given(
        *args: Any,
        system: str | None,
        hamiltonian: str | None,
        params: tuple[str, ...],
        **options: Any,
    ) -> Any:
        exact = hamiltonian_of(system, hamiltonian, params, kept=kept)
        return command(*args, exact=exact, **options)

    return hamiltonian_options(given)


with_kept_hamiltonian = partial(with_hamiltonian, kept=True)


def values_of(params: tuple[str, ...]) -> dict[str, str]:
    """The values of NAME=VALUE by their names. Raises InputError."""
    values: dict[str, str] = {}
    for text in params:
        name, given, value = text.partition("=")
        if not given:
            raise InputError("--param", text, "has no value; write NAME=VALUE, or leave it out")
        if name in values:
            raise InputError("--param", text, f"{name} is given twice")
        if "=" in value and re.search("[,;]", value):
            instead = " --param ".join(part.strip() for part in re.split("[,;]", text))
            raise InputError("--param", text, f"is more than one; write --param {instead}")
        values[name.strip()] = value
    return values


def hamiltonian_of(
    system: str | None, hamiltonian: str | None, params: tuple[str, ...], *, kept: bool = False
) -> "Hamiltonian":
    """The Hamiltonian that the options name; InputError unless they name one."""
    from verify.hamiltonians import systems
    from verify.hamiltonians.hamiltonian import Hamiltonian

    if (system is None) == (hamiltonian is None):
        raise InputError("--system, --hamiltonian", system or NOT_GIVEN, "give one of the two")
    values = values_of(params)
    if system is not None:
        source, read = f"system {system}", systems.get(system).hamiltonian
    else:
        systems.check_is_formula(hamiltonian or "")
        source, read = f"formula {hamiltonian}", partial(Hamiltonian.parse, hamiltonian or "")
    if not kept:
        return read(values)
    from verify.hamiltonians.kept import kept_or_read

    return kept_or_read(source, values, read)


def one_or_every(every: bool, named: Mapping[str, Any], **only: Any) -> "Hamiltonian | None":
    """The one H that the options name; None where every one is meant. InputError where they name
    one all the same, and where one is meant and an option is given that goes with every `only`."""
    if every:
        if any(given not in (None, ()) for given in named.values()):
            problem = "goes without --system, --hamiltonian, --param"
            raise InputError("every_hamiltonian", NOT_GIVEN, problem)
        return None
    for option, given in only.items():
        if given:
            raise InputError(option, NOT_GIVEN, "goes with --every-hamiltonian")
    return hamiltonian_of(**named)


def listed(given: str, exact: "Hamiltonian") -> str | list[str]:
    """The number; of an H of p1 … qn a list, the numbers that commas part.

    Whoever takes them says so where there are too few or too many.
    """
    if exact.planar:
        return given
    return [part.strip() for part in given.split(",")]


def paper_folder() -> Path:
    """Where the paper's own scenes and claims are."""
    return content("reports", "paper")


def target(scene: str, *others: str) -> "tuple[str, list[Scene], ClaimsFile | None]":
    """Title, scenes and claims of `paper`, of a suite, or of a scene's file.

    `others`: names that the command takes too, for those that are told where there is no such.
    """
    from verify.scenes.scene import load_scene

    if scene in suites():
        return suites()[scene], _suite(scene), None
    if scene != "paper":
        if not scene.strip():
            raise InputError("SCENE", scene, "is empty; give paper, a suite or a TOML file")
        if not Path(scene).suffix and not Path(scene).exists():
            here = {path.stem: path.name for path in sorted(Path.cwd().glob("*.toml"))}
            named = ("paper", *suites(), *others)
            raise unknown("SCENE", scene, named, ", or a TOML file", here)
        loaded = load_scene(Path(scene))
        return loaded.title or loaded.name, [loaded], None
    from verify.claims.file import load_claims

    folder = paper_folder()
    scenes = [load_scene(path) for path in sorted(folder.glob("*.toml")) if path.stem != "claims"]
    file = load_claims(folder / "claims.toml")
    return file.title, scenes, file


def suites() -> dict[str, str]:
    """The title of each suite, which a file in its folder holds."""
    titles = sorted(content("reports", "suites").glob("*/title.txt"))
    return {title.parent.name: title.read_text("utf-8").strip() for title in titles}


def _suite(name: str) -> "list[Scene]":
    from verify.scenes.scene import load_scene

    return [load_scene(path) for path in sorted(content("reports", "suites", name).glob("*.toml"))]
