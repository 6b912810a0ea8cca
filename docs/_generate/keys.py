"""A table of the keys of a model: what each may be given, its default, and what it says."""

from collections.abc import Collection

from pydantic import BaseModel

from docs._generate.attribute_texts import texts
from docs._generate.markdown import code, prose, table
from docs._generate.values import allowed, default

_HEAD = ("key", "takes", "default", "says")


def keys(model: type[BaseModel], without: Collection[str] = ()) -> str:
    """The table. KeyError for a key that nothing is said of."""
    said = texts(model)
    return table(
        _HEAD,
        (
            (code(key), allowed(model, key), default(field), prose(said[key]))
            for key, field in model.model_fields.items()
            if key not in without
        ),
    )
