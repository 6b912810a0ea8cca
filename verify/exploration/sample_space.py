"""From what scenes are drawn."""

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
