"""The base of all data here: frozen models that refuse what they do not know."""

from functools import cache
from typing import Annotated, Any, get_args

from pydantic import (
    BaseModel,
    ConfigDict,
    GetJsonSchemaHandler,
    PlainSerializer,
    PlainValidator,
    SerializationInfo,
    SerializerFunctionWrapHandler,
    WithJsonSchema,
    model_serializer,
    model_validator,
)

from verify.prose import Prose

Real = Annotated[float, PlainSerializer(repr, str, when_used="json")]  # of no exact value
Seconds = Real
PLAIN = {"parts": False}  # a context of `model_dump`
_BESIDE = "_parts"  # the key of a prose's parts is its own and this
_PARTS_SCHEMA = {"type": "array"}  # of texts and tables, or of such arrays


def _read(given: object) -> Prose:
    return given if isinstance(given, Prose) else Prose.of_data(given)


Said = Annotated[  # a field of Prose, in a model `WithProse`
    Prose, PlainValidator(_read), PlainSerializer(str), WithJsonSchema({"type": "string"})
]


class Frozen(BaseModel):
    """A frozen model that refuses unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Section(Frozen):
    """What a scene asks for, in a table of its own."""


class OfScheme(Frozen):
    """What was found of a scheme for one H with its parameter values."""

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str


class WithProse(Frozen):
    """A model with fields that are `Said`: each is its plain text in data.

    Where one is more than text, `NAME_parts` stands beside it; what is read may leave that out.
    With `context=PLAIN` it is left out, as in what commands print. Raises ValueError where the
    parts are not those of the text.
    """

    @model_serializer(mode="wrap")
    def _parts_beside(
        self, shown: SerializerFunctionWrapHandler, info: SerializationInfo
    ) -> dict[str, Any]:
        data: dict[str, Any] = {}
        with_parts = () if info.context == PLAIN else _prose_fields(type(self))
        for name, value in shown(self).items():
            data[name] = value
            if name in with_parts and _more_than_text(getattr(self, name)):
                data[name + _BESIDE] = _data_of(getattr(self, name))
        return data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """That of its fields, and of what stands beside them."""
        schema = handler(_unserialized(core_schema))
        own = handler.resolve_ref_schema(schema)
        beside = {name + _BESIDE: _PARTS_SCHEMA for name in _prose_fields(cls)}
        own["properties"] = {**own.get("properties", {}), **beside}
        return schema

    @model_validator(mode="before")
    @classmethod
    def _join_parts(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        data = dict(given)
        for name in _prose_fields(cls):
            parts = data.pop(name + _BESIDE, None)
            if parts is not None:
                data[name] = _checked(parts, data.get(name), name)
        return data


def _unserialized(schema: Any) -> Any:
    """The core schema of a model without its serializer, of whose data pydantic knows no keys."""
    return {key: value for key, value in schema.items() if key != "serialization"}


@cache
def _prose_fields(model: type[BaseModel]) -> tuple[str, ...]:
    return tuple(n for n, field in model.model_fields.items() if _holds_prose(field.annotation))


def _holds_prose(annotation: Any) -> bool:
    return annotation is Prose or any(_holds_prose(each) for each in get_args(annotation))


def _more_than_text(value: Any) -> bool:
    if isinstance(value, Prose):
        return any(type(part) is not str for part in value.parts)
    return any(_more_than_text(each) for each in value)


def _data_of(value: Any) -> Any:
    """The parts of a prose, or of each in a tuple of such."""
    return value.as_data() if isinstance(value, Prose) else [_data_of(each) for each in value]


def _checked(parts: Any, text: Any, name: str) -> Any:
    """The prose of these parts; in a list, where the text is one."""
    if isinstance(text, list | tuple):
        if not isinstance(parts, list | tuple) or len(parts) != len(text):
            raise ValueError(f"{name}{_BESIDE} has another length than {name}")
        return [_checked(*each, name) for each in zip(parts, text, strict=True)]
    found = Prose.of_data(parts)
    if text is not None and found != text:
        raise ValueError(f"{name}{_BESIDE} do not make up {name}")
    return found
