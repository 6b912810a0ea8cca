"""The base classes of all data here: frozen models that refuse unknown keys."""

from collections.abc import Iterator
from functools import cache
from typing import Annotated, Any, Self, get_args

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
# The context of `model_dump` that leaves out the parts of prose.
PLAIN = {"parts": False}
# The parts of the prose NAME are written under the key NAME_parts.
_PARTS_SUFFIX = "_parts"
# An array of texts and tables, or of such arrays.
_PARTS_SCHEMA = {"type": "array"}


def _read_prose(content: object) -> Prose:
    return content if isinstance(content, Prose) else Prose.from_data(content)


ProseText = Annotated[  # a field of Prose, in a model `WithProse`
    Prose, PlainValidator(_read_prose), PlainSerializer(str), WithJsonSchema({"type": "string"})
]


class Frozen(BaseModel):
    """A frozen model that refuses unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    @classmethod
    def from_object(cls, source: object, **other_fields: Any) -> Self:
        """Return the model with these fields, and the others from the attributes of `source`.

        A field that is neither has its default.
        """
        names = [n for n in cls.model_fields if n not in other_fields and hasattr(source, n)]
        return cls(**{name: getattr(source, name) for name in names}, **other_fields)


class Section(Frozen):
    """A section of a scene: requests in a table of its own."""

    def starts(self) -> Iterator[tuple[str, Any]]:
        """Yield the initial values of its runs, each behind its place in the section."""
        for k, start in enumerate(getattr(self, "initial_values", None) or ()):
            yield f"initial_values.{k}", start
        if (start := getattr(self, "initial_value", None)) is not None:
            yield "initial_value", start


class TitledScheme:
    """The scheme of a result, for heads and legends."""

    scheme: str

    @property
    def scheme_title(self) -> str:
        """The title that its user gave the scheme, or of a splitting of a field its steps."""
        from verify.schemes import separate_title
        from verify.schemes.field_splitting import separate_parts

        return separate_title(self.scheme)[0] or separate_parts(self.scheme)[0]

    @property
    def scheme_parts(self) -> str:
        """The text that the title leaves out: formulas, or the parts of a splitting of a field."""
        return self.scheme[len(self.scheme_title) :].lstrip(": ").removeprefix("with ")


class OfScheme(TitledScheme, Frozen):
    """A result on one scheme for one H with its parameter values."""

    hamiltonian: str
    parameters: dict[str, str]
    scheme: str

    @property
    def order_of_delta_j(self) -> int | None:
        """The proved order in h of ΔJ = det J − 1; None if there is none."""
        return None


class WithProse(Frozen):
    """A model with fields of type `ProseText`, each of which is its plain text in data.

    Where the prose NAME has formulas or numbers, its parts are written as `NAME_parts`, which data
    that are read may leave out. With `context=PLAIN` they are not written, as in the output of
    commands. Raises ValueError if the parts do not make up the text.
    """

    @model_serializer(mode="wrap")
    def _serialize_parts(
        self, handler: SerializerFunctionWrapHandler, info: SerializationInfo
    ) -> dict[str, Any]:
        data: dict[str, Any] = {}
        with_parts = () if info.context == PLAIN else _prose_fields(type(self))
        for name, value in handler(self).items():
            data[name] = value
            if name in with_parts and _more_than_text(getattr(self, name)):
                data[name + _PARTS_SUFFIX] = _data_of(getattr(self, name))
        return data

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Return the schema of the fields, with the parts of prose added."""
        schema = handler(_without_serializer(core_schema))
        resolved = handler.resolve_ref_schema(schema)
        parts = {name + _PARTS_SUFFIX: _PARTS_SCHEMA for name in _prose_fields(cls)}
        resolved["properties"] = {**resolved.get("properties", {}), **parts}
        return schema

    @model_validator(mode="before")
    @classmethod
    def _join_parts(cls, content: Any) -> Any:
        if not isinstance(content, dict):
            return content
        data = dict(content)
        for name in _prose_fields(cls):
            # The plain text stays readable for every program; the parts keep what it loses.
            parts = data.pop(name + _PARTS_SUFFIX, None)
            if parts is not None:
                data[name] = _check_parts(parts, data.get(name), name)
        return data


def _without_serializer(schema: Any) -> Any:
    """Return a model's core schema without its serializer, whose keys pydantic cannot know."""
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
    """Return the parts of a prose, or of each prose in a tuple."""
    return value.as_data() if isinstance(value, Prose) else [_data_of(each) for each in value]


def _check_parts(parts: Any, text: Any, name: str) -> Any:
    """Return the prose with these parts, or a list of them where the text is a list."""
    if isinstance(text, list | tuple):
        if not isinstance(parts, list | tuple) or len(parts) != len(text):
            raise ValueError(f"{name}{_PARTS_SUFFIX} has another length than {name}")
        return [_check_parts(*pair, name) for pair in zip(parts, text, strict=True)]
    prose = Prose.from_data(parts)
    if text is not None and prose != text:
        raise ValueError(f"{name}{_PARTS_SUFFIX} do not make up {name}")
    return prose
