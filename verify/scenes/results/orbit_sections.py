"""Orbits looked at once in each period, or where they pass a surface, as they were found."""

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


class PoincareOrbit(Frozen):
    """Where an orbit passes: of each time the two coordinates that are drawn, decimals of a few
    digits.

    `q` and `p` are where it starts, and `energy` is H there. `known`: how many of the first points
    a second reckoning, with more digits or of another order, confirms; `error`: the greatest
    distance of the two reckonings among these, an estimate of their error. `left`: whether the
    orbit left every range.
    """

    q: tuple[str, ...]
    p: tuple[str, ...]
    energy: str
    points: tuple[tuple[str, str], ...]
    known: int
    error: str
    left: bool


class MapSections(Frozen):
    """One map's orbits; `arithmetic` followed them with `digits`. `map` is a scheme's name or that
    of the exact flow."""

    map: str
    orbits: tuple[PoincareOrbit, ...]
    arithmetic: str
    digits: int
    seconds: Seconds


class PoincareResult(Frozen):
    """What a section of the scene asks for: one entry a map.

    Drawn are the coordinates `draw` where `coordinate` passes `value`, upwards where it is
    `rising`; by a scheme in the step from z to Φ_h(z) at that Φ_θ(z), 0 < θ ≤ h, where it does.
    """

    kind: Literal["poincare"] = "poincare"
    coordinate: str
    value: str
    rising: bool
    draw: tuple[str, str]
    step_size: str
    steps: int
    time: str
    sections: tuple[MapSections, ...]
    source: str = ""
