"""The values that a scene's keys take: exact numbers, counts, initial values."""

from collections.abc import Callable, Collection, Iterable
from fractions import Fraction
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, PlainSerializer, Tag

from verify import arithmetic as number_systems
from verify import schemes
from verify.arithmetic.exact import Exact, positive, rational, text, whole
from verify.drawable import drawn_by
from verify.errors import NOT_GIVEN, InputError, unknown
from verify.hamiltonians import systems
from verify.hamiltonians.coordinates import MOST_DEGREES
from verify.scenes.frozen import Frozen

MAX_STEPS = 10**12
MAX_DIGITS = 10_000
AUTO = number_systems.AUTO

# Marks which of two models a table is read as; what names a key leaves it out.
OF_ONE, OF_SEVERAL = "«one»", "«several»"
Number = Annotated[
    Fraction, BeforeValidator(lambda x: rational(x, "number")), PlainSerializer(text)
]
Several = Annotated[tuple[Number, ...], Field(min_length=1, max_length=MOST_DEGREES)]
Coordinates = Annotated[  # of q or of p: a number, or in n degrees of freedom a list
    Annotated[Number, Tag(OF_ONE)] | Annotated[Several, Tag(OF_SEVERAL)],
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


def _known_arithmetic(name: str) -> str:
    if name != AUTO and name not in number_systems.names():
        raise unknown(
            "arithmetic", name, (AUTO, *number_systems.names()), aliases=number_systems.ALIASES
        )
    return name


ArithmeticName = Annotated[str, AfterValidator(_known_arithmetic)]


def auto_for_digits(data: Any) -> Any:
    """A section's keys, with `arithmetic` auto where digits are asked for and no arithmetic is."""
    wanted = isinstance(data, dict) and "digits" in data and "arithmetic" not in data
    return {**data, "arithmetic": AUTO} if wanted else data


def read_range(
    given: Any,
    read: Callable[[Any, str], Fraction],
    values: Callable[[Fraction, Fraction, int], Iterable[Fraction]],
) -> Any:
    """A table with from, to and count as the list of `values` that it stands for; else as it is.

    `read`: how its ends are read, by their names.
    """
    if not isinstance(given, dict):
        return given
    if set(given) != {"from", "to", "count"}:
        raise InputError("range", ", ".join(map(str, given)), "allowed: from, to, count")
    low, high = read(given["from"], "from"), read(given["to"], "to")
    count = whole("count", given["count"], 2, 200)
    if low >= high:
        raise InputError("from, to", given["from"], "from must be less than to")
    return tuple(values(low, high, count))


def one_length(time: Fraction | None, steps: int | None) -> None:
    """InputError unless one of the two says how long a run is."""
    if (time is None) == (steps is None):
        raise InputError("time, steps", NOT_GIVEN, "give one of the two")


def distinct(name: str, given: Collection[object]) -> None:
    """InputError where one of the values under this key stands twice."""
    if len(set(given)) < len(given):
        raise InputError(name, len(given), "one of them stands twice; leave it out")


def steps_of(time: Fraction | None, steps: int | None, h: Fraction, most: int = MAX_STEPS) -> int:
    """N: as given, or T/h rounded down to a whole number; InputError beyond `most`.

    That is the rule wherever a time is given: a run ends at t = N·h, and `rounded_down` says so.
    """
    count = steps if time is None else time // h
    if count is None or not 1 <= count <= most:
        raise InputError("step_size", text(h), f"makes {count} steps; allowed: 1 … {most}")
    return count


def steps_from(steps: int | None, time: Exact | None, step_size: Exact) -> int:
    """N, as it is given or as many whole steps as fit into the time.

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


def rounded_down(time: Fraction | None, step_sizes: Iterable[Fraction]) -> str:
    """What is said where T/h is not a whole number for some of the h; empty where it is for all.

    >>> rounded_down(Fraction(10), [Fraction(3, 10), Fraction(1, 10)])
    'T/h is rounded down: h = 0.3 gives N = 33, and t = 9.9 at the end'
    """
    rest = [h for h in dict.fromkeys(step_sizes) if time is not None and time % h]
    if time is None or not rest:
        return ""
    told = (f"h = {text(h)} gives N = {time // h}, and t = {text(time // h * h)}" for h in rest)
    return f"T/h is rounded down: {'; '.join(told)} at the end"


@drawn_by("initial_values")
class InitialValue(Frozen):
    """Where a run starts, exactly."""

    q: Number
    """The displacement."""
    p: Number
    """The momentum."""


class InitialState(Frozen):
    """Where a run in n degrees of freedom starts, exactly."""

    q: Several
    """The displacements, q1 … qn."""
    p: Several
    """The momenta, p1 … pn."""


def _which(given: Any) -> str:
    """Whether a table, or a model, has lists."""
    q = given.get("q", given.get("p")) if isinstance(given, dict) else getattr(given, "q", None)
    return OF_SEVERAL if isinstance(q, list | tuple) else OF_ONE


Start = Annotated[
    Annotated[InitialValue, Tag(OF_ONE)] | Annotated[InitialState, Tag(OF_SEVERAL)],
    Discriminator(_which),
]
