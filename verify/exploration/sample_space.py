"""The space from which scenes are drawn."""

from verify.errors import InputError
from verify.scenes.frozen import Frozen


class SampleSpace(Frozen):
    """The space of drawn scenes: the kinds of H up to a degree, the schemes (empty: all), the
    dependence of H on t, and the number of degrees of freedom.

    >>> SampleSpace(kinds=("polynomial",), schemes=("lie2",)).degree
    6
    """

    kinds: tuple[str, ...] = ()
    degree: int = 6
    schemes: tuple[str, ...] = ()
    time_dependent: bool = False
    degrees: int = 1


def check_scenes(seed: int, examples: int, limit: int) -> None:
    """Raise InputError unless so many scenes of the seed may be drawn."""
    if not 1 <= examples <= limit:
        raise InputError("examples", examples, f"must be 1 … {limit}")
    if seed < 0:
        raise InputError("seed", seed, "must be 0 or more")
