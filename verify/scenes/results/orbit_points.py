"""Results on orbits once in each period, or where they pass a surface."""

from typing import Literal

from verify.scenes.frozen import Frozen, Seconds, TitledScheme


class StroboscopicOrbit(Frozen):
    """The states (q, p) at the start and after 1, 2, … periods, decimals of a few digits.

    `known`: the index of the last state that more digits confirm; later ones are artefacts of the
    number format and need not be near the orbit. `in_float64`: the index of the last state that has
    the same place in float64, as far as a picture shows. `left`: True if it left every range.
    """

    q: str
    p: str
    points: tuple[tuple[str, str], ...]
    known: int
    in_float64: int
    left: bool


class SchemeSections(TitledScheme, Frozen):
    """The orbits of one scheme, followed in `arithmetic` with `digits` digits."""

    scheme: str
    orbits: tuple[StroboscopicOrbit, ...]
    arithmetic: str
    digits: int
    seconds: Seconds


class StroboscopicResult(Frozen):
    """The result of a stroboscopic section, an entry for each scheme; `t0` if H depends on time.

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
    """The points where an orbit passes: the two drawn coordinates, as decimals of a few digits.

    `q` and `p` are its initial value, and `energy` is H there. `known`: how many of the first
    points a second computation, with more digits or of another order, confirms; `error`: the
    greatest distance between the two computations among these, an estimate of their error. `left`:
    True if the orbit left every range.
    """

    q: tuple[str, ...]
    p: tuple[str, ...]
    energy: str
    points: tuple[tuple[str, str], ...]
    known: int
    error: str
    left: bool


class MapSections(Frozen):
    """The orbits of one map, followed in `arithmetic` with `digits` digits.

    `map` is a scheme's name or that of the exact flow.
    """

    map: str
    orbits: tuple[PoincareOrbit, ...]
    arithmetic: str
    digits: int
    seconds: Seconds


class PoincareResult(Frozen):
    """The result of a Poincaré section, an entry for each map.

    The points are the coordinates `draw` where `coordinate` passes `value`, upwards if `rising`. A
    scheme's orbit passes in the step from z to Φ_h(z) at the Φ_θ(z), 0 < θ ≤ h, on the surface.
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
