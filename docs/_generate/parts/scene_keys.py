"""The keys of a scene and of its sections, from the models that read them."""

from collections.abc import Iterator
from typing import Any, get_args

from pydantic import BaseModel

from docs._generate.keys import keys
from verify.scenes.scene import Scene


def text() -> str:
    """A table of the scene's own keys, and a section for each of its sections."""
    return "\n".join([keys(Scene), *_sections()])


def _sections() -> Iterator[str]:
    for name, field in Scene.model_fields.items():
        for model in _models(field.annotation):
            head = f"[[{name}]]" if _is_repeated(field.annotation) else f"[{name}]"
            yield f"### {head}\n\n{keys(model)}"


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for each in get_args(annotation):
        yield from _models(each)


def _is_repeated(annotation: Any) -> bool:
    return getattr(annotation, "__origin__", None) is tuple
