"""The base of all data here: frozen models that refuse what they do not know."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, PlainSerializer

Real = Annotated[float, PlainSerializer(repr, str, when_used="json")]  # of no exact value
Seconds = Real


class Frozen(BaseModel):
    """A frozen model that refuses unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid")
