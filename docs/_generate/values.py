"""What a key of a scene or of a claim may be given, in words, from its annotation."""

from collections.abc import Iterator
from fractions import Fraction
from inspect import get_annotations
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from docs._generate.markdown import code
from verify.arithmetic.exact import text as exact_text
from verify.scenes import values

# Those whose rules are functions, which say nothing of themselves.
_NAMED = {
    values.ExactNumber: "number",
    values.StepSize: "number > 0",
    values.Time: "number > 0",
    values.SchemeName: "scheme",
    values.SystemName: "system",
    values.ArithmeticName: "number system",
}
_PLAIN = {str: "text", int: "whole number", bool: "`true` or `false`", Fraction: "number",
          float: "number", Any: "anything", NoneType: "", ...: "…"}  # fmt: skip
_ASKED = ("ge", "gt", "le", "lt", "min_length", "max_length")
_FEW = 2  # keys of a table that is shown where it stands
_LONG = 4  # zeros of a number that is shown as a power


def allowed(model: type[BaseModel], key: str) -> str:
    """Such as `number > 0, 1 … 100 of them`."""
    return _words(next(ours[key] for ours in map(get_annotations, model.__mro__) if key in ours))


def default(field: FieldInfo) -> str:
    """The default as one would write it; `required` where there is none."""
    if field.is_required():
        return "required"
    return _written(field.get_default(call_default_factory=True))


def _written(value: Any) -> str:
    if value is None or value in ("", (), {}):
        return ""
    if isinstance(value, bool):
        return code(str(value).lower())
    if isinstance(value, Fraction):
        return code(exact_text(value))
    if isinstance(value, BaseModel):
        pairs = (f"{k} = {exact_text(x)}" for k, x in value)
        return code("{ " + ", ".join(pairs) + " }")
    if isinstance(value, tuple):
        return code("[" + ", ".join(f'"{x}"' for x in value) + "]")
    return code(str(value))


def _words(hint: Any) -> str:
    if hint in _NAMED:
        return _NAMED[hint]
    if hint is values.NamedState:
        return "{ NAME = number, … }"
    origin, given = get_origin(hint), get_args(hint)
    if origin is Annotated:
        inner, *more = given
        return ", ".join([_words(inner), *_limits(inner, more)])
    if origin in (Union, UnionType):
        return " or ".join(filter(None, map(_words, given)))
    if origin is Literal:
        return " or ".join(code(str(x)) for x in given)
    if origin is tuple:
        return f"[{', '.join(map(_words, given))}]"
    if origin is dict:
        return f"{{ name = {_words(given[1])}, … }}"
    if isinstance(hint, type) and issubclass(hint, BaseModel):
        return _table(hint)
    return _PLAIN[hint]


def _table(model: type[BaseModel]) -> str:
    """A small table by its keys; a large one has a section of its own."""
    if len(model.model_fields) > _FEW:
        return "table"
    keys = (f"{key} = {allowed(model, key)}" for key in model.model_fields)
    return f"{{ {', '.join(keys)} }}"


def _limits(hint: Any, metadata: list[Any]) -> Iterator[str]:
    """What more is asked: a range, a number of characters or entries, a pattern."""
    found: dict[str, Any] = {}
    for each in (x for m in metadata for x in (m.metadata if isinstance(m, FieldInfo) else [m])):
        found |= {
            name: getattr(each, name) for name in _ASKED if getattr(each, name, None) is not None
        }
    low, high = found.get("ge"), found.get("le")
    if low is not None and high is not None:
        yield f"{_count(low)} … {_count(high)}"
    else:
        signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<"}
        yield from (
            f"{sign} {_count(found[name])}" for name, sign in signs.items() if name in found
        )
    least, most = found.get("min_length", 0), found.get("max_length")
    unit = "characters" if hint is str else "of them"
    if least and most:
        yield f"{least} … {_count(most)} {unit}"
    elif least or most:
        yield f"at {'least' if least else 'most'} {_count(least or most)} {unit}"


def _count(number: Any) -> str:
    """A power of ten that is large as such."""
    shown = str(number)
    zeros = len(shown) - 1
    return f"10^{zeros}" if zeros > _LONG and shown == "1" + "0" * zeros else shown
