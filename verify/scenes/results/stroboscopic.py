"""Orbits looked at once in each period, as they were found."""

from typing import Literal

from verify.scenes.frozen import Frozen, Seconds


class StroboscopicOrbit(Frozen):
    """The states (q, p) at the start and after 1, 2, … periods, decimals of a few digits.

    `known`: the last of them that more digits confirm; those after it are of a number format, and
    the orbit's own for no one who cannot follow it with still more. `in_float64`: the last that is
    where it is in float64, too, as far as a picture shows. `left`: whether it left every range.
    """

    q: str
    p: str
    points: tuple[tuple[str, str], ...]
    known: int
    in_float64: int
    left: bool


class SchemeSections(Frozen):
    """One scheme's orbits; `arithmetic` followed them with `digits`."""

    scheme: str
    orbits: tuple[StroboscopicOrbit, ...]
    arithmetic: str
    digits: int
    seconds: Seconds


class StroboscopicResult(Frozen):
    """What a section of the scene asks for: one entry a scheme; `t0` where H depends on time.

    `q_is_angle`: H is the same at q + 2π, and a picture shows q within one turn.
    """

    kind: Literal["stroboscopic"] = "stroboscopic"
    period: str
    step_size: str
    periods: int
    t0: str | None
    q_is_angle: bool
    sections: tuple[SchemeSections, ...]
    source: str = ""
