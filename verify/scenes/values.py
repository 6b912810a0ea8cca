"""The values that a scene's keys take: exact numbers, counts, initial values."""

from fractions import Fraction
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, Field, PlainSerializer

from verify import arithmetic as number_systems
from verify.arithmetic.exact import positive, rational, text
from verify.drawable import drawn_by
from verify.errors import InputError
from verify.scenes.frozen import Frozen

MAX_STEPS = 10**12
MAX_DIGITS = 10_000
AUTO = number_systems.AUTO
CLOSED_FORM = ("delta_j_max", "mse", "lambda")
REPORTED = (*CLOSED_FORM, "lambda_plain")
OBSERVABLES = (*REPORTED, "lambda_max")  # the last: the greatest |Λ| after any of the steps

Number = Annotated[
    Fraction, BeforeValidator(lambda x: rational(x, "number")), PlainSerializer(text)
]
StepSize = Annotated[
    Fraction, BeforeValidator(lambda x: positive(x, "step_size")), PlainSerializer(text)
]
Time = Annotated[Fraction, BeforeValidator(lambda x: positive(x, "time")), PlainSerializer(text)]
Digits = Annotated[int, Field(ge=1, le=MAX_DIGITS, strict=True)]
Steps = Annotated[int, Field(ge=1, le=MAX_STEPS, strict=True)]


def _known_arithmetic(name: str) -> str:
    if name != AUTO and name not in number_systems.names():
        allowed = ", ".join((AUTO, *number_systems.names()))
        raise InputError("arithmetic", name, f"unknown; allowed: {allowed}")
    return name


ArithmeticName = Annotated[str, AfterValidator(_known_arithmetic)]


@drawn_by("initial_values")
class InitialValue(Frozen):
    """Where a run starts, exactly."""

    q: Number
    p: Number
