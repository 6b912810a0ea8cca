"""Orbits looked at where they pass a surface, as they were found."""

from typing import Literal

from verify.scenes.frozen import Frozen, Seconds


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
