"""The public names of `verify`, and of its public modules, for autodoc."""

import inspect
from collections.abc import Iterable, Iterator
from types import ModuleType

import verify
from verify import strategies, testing

_FURTHER = (testing, strategies)
_MEMBERS = (":members:", ":exclude-members: model_config, model_post_init")  # pydantic's own


def text() -> str:
    """Calls, then classes, then what modules have."""
    found = {name: getattr(verify, name) for name in verify.__all__}
    calls = [f"verify.{name}" for name, x in found.items() if inspect.isfunction(x)]
    classes = [f"verify.{name}" for name, x in found.items() if inspect.isclass(x)]
    modules = {f"verify.{name}": x for name, x in found.items() if isinstance(x, ModuleType)}
    sections = [
        *_section("Calls", _directives("function", calls)),
        *_section("Classes", _directives("class", classes, *_MEMBERS)),
    ]
    for name, module in (modules | {each.__name__: each for each in _FURTHER}).items():
        sections += _section(name, _of_module(module))
    return "\n".join(sections)


def _section(title: str, directives: Iterable[str]) -> list[str]:
    return [f"## {title}", "", "```{eval-rst}", *directives, "```", ""]


def _directives(kind: str, names: Iterable[str], *options: str) -> Iterator[str]:
    for name in names:
        yield "\n".join([f".. auto{kind}:: {name}", *(f"   {option}" for option in options), ""])


def _of_module(module: ModuleType) -> Iterator[str]:
    """Its own functions, or those that it says are public."""
    names = getattr(module, "__all__", None) or [
        name
        for name, x in vars(module).items()
        if inspect.isroutine(inspect.unwrap(x)) and not name.startswith("_")
        if x.__module__ == module.__name__
    ]
    yield from _directives("function", (f"{module.__name__}.{name}" for name in names))
