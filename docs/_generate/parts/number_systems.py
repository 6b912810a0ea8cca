"""The number systems: what each says of itself before it computes."""

from docs._generate.markdown import code, codes, prose, table
from verify.arithmetic import ALIASES, about, names
from verify.arithmetic.number_system import NumberSystem

_HEAD = ("number system", "also called", "is", "digits", "a step costs", "compiled", "`auto`")


def text() -> str:
    """A table of all of them."""
    return table(_HEAD, (_row(about(name)) for name in names()))


def _row(system: NumberSystem) -> tuple[str, ...]:
    most = f"fastest up to {system.most_digits:g}" if system.most_digits < float("inf") else "any"
    return (
        code(system.name),
        codes(alias for alias, name in ALIASES.items() if name == system.name),
        prose(system.about),
        str(system.digits) if system.digits else most,
        f"{system.cost} of float64's",
        "yes" if system.compiles else "",
        "tries it" if system.automatic else "",
    )
