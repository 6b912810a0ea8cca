"""The values of a scene's keys: exact numbers, counts, initial values."""

from collections.abc import Callable, Collection, Iterable
from fractions import Fraction
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Discriminator,
    Field,
    PlainSerializer,
    Tag,
    model_serializer,
    model_validator,
)

from verify import arithmetic as number_systems
from verify import schemes
from verify.arithmetic.exact import Number, positive, rational, text, whole
from verify.drawable import drawn_by
from verify.errors import NOT_GIVEN, InputError, unknown_name
from verify.hamiltonians import systems
from verify.hamiltonians.coordinates import MAX_DEGREES
from verify.hamiltonians.hamiltonian import Hamiltonian
from verify.hamiltonians.run_domain import start_of
from verify.scenes.frozen import Frozen

MAX_STEPS = 10**12
MAX_DIGITS = 10_000
AUTO = number_systems.AUTO

# Tags of the models as which a table can be read; messages leave them out of keys.
OF_ONE, OF_SEVERAL, BY_NAME = "«one»", "«several»", "«by name»"
ExactNumber = Annotated[
    Fraction, BeforeValidator(lambda x: rational(x, "number")), PlainSerializer(text)
]
Several = Annotated[tuple[ExactNumber, ...], Field(min_length=1, max_length=MAX_DEGREES)]
Coordinates = Annotated[  # of q or of p: a number, or in n degrees of freedom a list
    Annotated[ExactNumber, Tag(OF_ONE)] | Annotated[Several, Tag(OF_SEVERAL)],
    Discriminator(lambda x: OF_SEVERAL if isinstance(x, list | tuple) else OF_ONE),
]
StepSize = Annotated[
    Fraction, BeforeValidator(lambda x: positive(x, "step_size")), PlainSerializer(text)
]
Time = Annotated[Fraction, BeforeValidator(lambda x: positive(x, "time")), PlainSerializer(text)]
SchemeName = Annotated[str, AfterValidator(schemes.canonical)]
SystemName = Annotated[str, AfterValidator(systems.canonical)]
Digits = Annotated[int, Field(ge=1, le=MAX_DIGITS, strict=True)]
Steps = Annotated[int, Field(ge=1, le=MAX_STEPS, strict=True)]


def _check_arithmetic(name: str) -> str:
    if name != AUTO and name not in number_systems.names():
        raise unknown_name(
            "arithmetic", name, (AUTO, *number_systems.names()), aliases=number_systems.ALIASES
        )
    return name


ArithmeticName = Annotated[str, AfterValidator(_check_arithmetic)]


def auto_for_digits(data: Any) -> Any:
    """Return a section's keys, with `arithmetic` auto where only digits are requested."""
    needs_auto = isinstance(data, dict) and "digits" in data and "arithmetic" not in data
    return {**data, "arithmetic": AUTO} if needs_auto else data


def read_range(
    value: Any,
    read: Callable[[Any, str], Fraction],
    values: Callable[[Fraction, Fraction, int], Iterable[Fraction]],
) -> Any:
    """Return the `values` that a table with from, to and count stands for; other data unchanged.

    `read`: reads an end by its value and its name.
    """
    if not isinstance(value, dict):
        return value
    if set(value) != {"from", "to", "count"}:
        raise InputError("range", ", ".join(map(str, value)), "allowed: from, to, count")
    low, high = read(value["from"], "from"), read(value["to"], "to")
    count = whole("count", value["count"], 2, 200)
    if low >= high:
        raise InputError("from, to", value["from"], "from must be less than to")
    return tuple(values(low, high, count))


def check_one_length(time: Fraction | None, steps: int | None) -> None:
    """Raise InputError unless exactly one of the two gives the length of a run."""
    if (time is None) == (steps is None):
        raise InputError("time, steps", NOT_GIVEN, "give one of the two")


def check_distinct(name: str, values: Collection[object]) -> None:
    """Raise InputError if one of the values under this key occurs twice."""
    if len(set(values)) < len(values):
        raise InputError(name, len(values), "one of them stands twice; leave it out")


def count_steps(
    time: Fraction | None, steps: int | None, h: Fraction, most: int = MAX_STEPS
) -> int:
    """Return N: `steps`, or T/h rounded down to a whole number; InputError beyond `most`.

    This rule holds for every time: a run ends at t = N·h, which `describe_rounding` reports.
    """
    # Exact rationals: 1 // 0.1 is 10 here, where floats give 9.
    count = steps if time is None else time // h
    if count is None or not 1 <= count <= most:
        raise InputError("step_size", text(h), f"makes {count} steps; allowed: 1 … {most}")
    return count


def steps_from(steps: int | None, time: Number | None, step_size: Number) -> int:
    """Return N: `steps`, or the number of whole steps that fit into the time.

    >>> steps_from(None, 1, 0.1), steps_from(None, 1, 0.3)
    (10, 3)
    """
    if (steps is None) == (time is None):
        raise InputError(
            "steps, time", steps if steps is not None else NOT_GIVEN, "give one of the two"
        )
    if time is None:
        return whole("steps", steps, 1, MAX_STEPS)
    count = positive(time, "time") // positive(step_size, "step_size")
    if not 1 <= count <= MAX_STEPS:
        raise InputError("time", time, f"makes {count} steps; allowed: 1 … {MAX_STEPS}")
    return count


def describe_rounding(time: Fraction | None, step_sizes: Iterable[Fraction]) -> str:
    """Return a sentence on the h for which T/h is not a whole number; "" where there are none.

    >>> describe_rounding(Fraction(10), [Fraction(3, 10), Fraction(1, 10)])
    'T/h is rounded down: h = 0.3 gives N = 33, and t = 9.9 at the end'
    """
    inexact = [h for h in dict.fromkeys(step_sizes) if time is not None and time % h]
    if time is None or not inexact:
        return ""
    clauses = (
        f"h = {text(h)} gives N = {time // h}, and t = {text(time // h * h)}" for h in inexact
    )
    return f"T/h is rounded down: {'; '.join(clauses)} at the end"


@drawn_by("initial_values")
class InitialValue(Frozen):
    """The exact initial value of a run."""

    q: ExactNumber
    """The displacement."""
    p: ExactNumber
    """The momentum."""


class InitialState(Frozen):
    """The exact initial value of a run in n degrees of freedom."""

    q: Several
    """The displacements, q1 … qn."""
    p: Several
    """The momenta, p1 … pn."""


class NamedState(Frozen):
    """The exact initial value of a run of equations without an H: each coordinate by its name."""

    values: tuple[tuple[str, ExactNumber], ...]
    """The names with their numbers, which are the keys of its table."""

    @model_validator(mode="before")
    @classmethod
    def _read_table(cls, data: Any) -> Any:
        if not isinstance(data, dict) or isinstance(data.get("values"), tuple):
            return data
        # In an order that does not depend on how the table is written.
        pairs = sorted(data.items(), key=lambda pair: str(pair[0]))
        return {"values": tuple((name, rational(x, str(name))) for name, x in pairs)}

    @model_serializer
    def _as_table(self) -> dict[str, str]:
        return {name: text(value) for name, value in self.values}


def _count_tag(value: Any) -> str:
    """Return the tag of a table or a model: of several where it has lists, else of one."""
    q = value.get("q", value.get("p")) if isinstance(value, dict) else getattr(value, "q", None)
    return OF_SEVERAL if isinstance(q, list | tuple) else OF_ONE


Start = Annotated[
    Annotated[InitialValue, Tag(OF_ONE)] | Annotated[InitialState, Tag(OF_SEVERAL)],
    Discriminator(_count_tag),
]


def _start_tag(value: Any) -> str:
    """Return the tag of a table or a model: by name where it has other names than q and p."""
    has_names = isinstance(value, dict) and not {*value} <= {"q", "p"}
    return BY_NAME if has_names or isinstance(value, NamedState) else _count_tag(value)


AnyStart = Annotated[  # also of equations without an H
    Annotated[InitialValue, Tag(OF_ONE)]
    | Annotated[InitialState, Tag(OF_SEVERAL)]
    | Annotated[NamedState, Tag(BY_NAME)],
    Discriminator(_start_tag),
]


def start_arguments(start: AnyStart, *, of_field: bool) -> dict[str, Any]:
    """Return an initial value as the arguments q and p of a run, or `start` of equations."""
    values = dict(start.values if isinstance(start, NamedState) else start)
    return {"start": values} if of_field else values


def check_initial_value(place: str, start: AnyStart, system: Hamiltonian) -> None:
    """Raise InputError, which names its place in a section, unless it is of these coordinates."""
    arguments = start_arguments(start, of_field=not system.has_energy)
    if system.has_energy and isinstance(start, NamedState):
        name = next(name for name in arguments if name not in ("q", "p"))
        missing = ", ".join(x for x in ("q", "p") if x not in arguments)
        problem = f"is one of these meant: {missing}?" if missing else "allowed: q, p"
        raise InputError(f"{place}.{name}", text(arguments[name]), f"unknown key; {problem}")
    try:
        start_of(system, *map(arguments.get, ("q", "p", "start")))
    except InputError as error:
        name = place if error.name == "start" else error.name
        raise type(error)(name, error.value, error.problem) from None
