"""From what scenes are drawn."""

from verify.errors import InputError
from verify.scenes.frozen import Frozen


class SampleSpace(Frozen):
    """From what scenes are drawn: these kinds of H up to a degree, these schemes (empty: all),
    whether H depends on t, and in how many degrees of freedom.

    >>> SampleSpace(kinds=("polynomial",), schemes=("lie2",)).degree
    6
    """

    kinds: tuple[str, ...] = ()
    degree: int = 6
    schemes: tuple[str, ...] = ()
    time_dependent: bool = False
    degrees: int = 1


def check_scenes(seed: int, examples: int, most: int) -> None:
    """InputError unless so many scenes of the seed may be asked for."""
    if not 1 <= examples <= most:
        raise InputError("examples", examples, f"must be 1 … {most}")
    if seed < 0:
        raise InputError("seed", seed, "must be 0 or more")
