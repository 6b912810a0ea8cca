"""Messages on keys and values that a model refuses: what they must be, and what to write."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from verify.errors import NOT_GIVEN, InputError, find_nearest, format_suggestion, plain_name

# Characters of a value that is quoted in a message.
_MAX_QUOTED = 30
# Names that others use for a key → the key here.
_SYNONYMS = {
    "h": "step_size", "dt": "step_size", "params": "parameters", "center": "centre",
    "method": "schemes", "integrator": "schemes", "x": "q", "v": "p", "t": "time", "n": "steps",
    "tmax": "time", "precision": "digits", "size": "scale",
}  # fmt: skip
Error = Mapping[str, Any]  # one of pydantic's `errors()`


def describe_first_error(
    error: ValidationError, source: str, model: type[BaseModel] | None = None
) -> InputError:
    """Return the first of pydantic's errors in one line, which names the key and its value.

    `model`: the model that was read, if its keys are to be listed.
    """
    errors: list[dict[str, Any]] = [
        {**e, "loc": _strip_tags(e["loc"])} for e in error.errors(include_url=False)
    ]
    # A mistyped key is also a missing one: name what was typed.
    first = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    cause = first.get("ctx", {}).get("error")
    path = ".".join(str(part) for part in first["loc"])
    if isinstance(cause, InputError):
        prefix = f"{source}: {path}: " if path else f"{source}: "
        return type(cause)(prefix + cause.name, cause.value, cause.problem)
    if first["type"] == "extra_forbidden":
        missing = [str(e["loc"][-1]) for e in errors if e["type"] == "missing"]
        problem = _unknown_key_mistake(first["loc"], missing, model)
        return InputError(f"{source}: {path}", first.get("input"), problem)
    if first["type"] == "missing":
        return InputError(
            f"{source}: {path}", NOT_GIVEN, f"is missing; write {first['loc'][-1]} = …"
        )
    return InputError(f"{source}: {path}", first.get("input"), _value_mistake(first, model))


def _strip_tags(loc: Sequence[str | int]) -> tuple[str | int, ...]:
    """Return a place without tags such as «one», the model as which a table was read."""
    return tuple(part for part in loc if not str(part).startswith("«"))


def _value_mistake(error: Error, model: type[BaseModel] | None) -> str:
    """Return what the value under a key must be, in place of pydantic's words."""
    value, context = error.get("input"), error.get("ctx", {})
    name = next((str(part) for part in reversed(error["loc"]) if isinstance(part, str)), "")
    tables = bool(_keys_at(error["loc"], model))  # or lists of them
    most, least = context.get("max_length"), context.get("min_length")
    explanations: dict[str, Callable[[], str]] = {
        "tuple_type": lambda: _list_mistake(name, value, tables),
        "list_type": lambda: _list_mistake(name, value, tables),
        "model_type": lambda: _table_mistake(name, value),
        "dict_type": lambda: f"must be a table; write {name} = {{ NAME = VALUE }}",
        "too_short": lambda: f"must be a list of {least} or more",
        "too_long": lambda: f"must be a list of {most} or fewer",
        "int_type": lambda: f"must be a whole number{_whole_number_hint(name, value)}",
        "greater_than_equal": lambda: f"must be {context['ge']} or more",
        "less_than_equal": lambda: f"must be {context['le']} or less",
        "string_type": lambda: "must be a text, in quotation marks",
        "string_too_long": lambda: f"must be a text of {most} characters at most",
        "string_pattern_mismatch": lambda: "must be of letters, digits, _ and - alone",
        "bool_type": lambda: "must be true or false, without quotation marks",
        "bool_parsing": lambda: "must be true or false, without quotation marks",
        "literal_error": lambda: f"must be {context['expected']}",
    }
    explanation = explanations.get(error["type"])
    return explanation() if explanation else str(error["msg"])


def _list_mistake(name: str, value: object, of_tables: bool) -> str:
    if isinstance(value, Mapping):
        tables = f" of tables; write [[{name}]] for [{name}]"
        return f"must be a list{tables if of_tables else f'; write {name} = […]'}"
    is_word = isinstance(value, str) and not value[:1].isdigit()
    example = "…" if is_word and name != "schemes" else f'"{value}"' if is_word else str(value)
    return f"must be a list; write {name} = [{example[:_MAX_QUOTED]}]"


def _table_mistake(name: str, value: object) -> str:
    if isinstance(value, list) and value and isinstance(value[0], Mapping):
        return f"must be one table; write [{name}] for [[{name}]]"
    keys = " with q and p, as { q = 1, p = 0 }" if name.startswith("initial_value") else ""
    return f"must be a table{keys}"


def _whole_number_hint(name: str, value: object) -> str:
    from verify.arithmetic.exact import rational

    try:
        number = rational(str(value))
    except InputError:
        return ""
    bare = " without quotation marks" if str(number) == value else ""
    return f"; write {name} = {number}{bare}" if number.denominator == 1 else ""


def _unknown_key_mistake(
    loc: Sequence[str | int], missing: Sequence[str], model: type[BaseModel] | None
) -> str:
    """Return a message on an unknown key: the keys that may be meant, or all that are allowed."""
    if missing:
        return f"unknown key; is one of these meant: {', '.join(missing)}?"
    allowed = _keys_at(loc[:-1], model)
    if not allowed:
        return "unknown key"
    key = plain_name(str(loc[-1])).replace("-", "_")
    candidates = [
        ours for ours in (_SYNONYMS.get(key), f"{_SYNONYMS.get(key)}s") if ours in allowed
    ]
    suggestion = format_suggestion(candidates[0] if candidates else find_nearest(key, allowed))
    return f"unknown key; {suggestion}allowed: {', '.join(allowed)}"


def _keys_at(loc: Sequence[str | int], model: type[BaseModel] | None) -> list[str]:
    for part in loc:
        if isinstance(part, str) and model is not None:
            field = model.model_fields.get(part)
            model = _model_in(field.annotation) if field else None
    return list(model.model_fields) if model else []


def _model_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((model for each in get_args(annotation) if (model := _model_in(each))), None)
