"""The named systems: H, parameters, regimes, and how the exact flow is known."""

from collections.abc import Iterator

from docs._generate.markdown import code, prose, table
from verify.hamiltonians.named_system import System
from verify.hamiltonians.systems import all_systems


def text() -> str:
    """A section for each of them."""
    return (
        "\n\n".join("\n\n".join(_section(system)) for system in all_systems(None).values()) + "\n"
    )


def _section(system: System) -> Iterator[str]:
    how = "in closed form" if system.has_closed_form else "by numbers"
    flow = f"The exact flow is known {how}."
    if system.family:
        flow = f"It has n degrees of freedom, here {system.degrees}."
    elif system.degrees > 1:
        flow = f"It has {system.degrees} degrees of freedom."
    yield f"### {system.name}"
    yield f"{prose(system.title)}: H = {code(system.formula)}. {flow}"
    if system.parameters:
        yield table(
            ("parameter", "is"), ((code(n), prose(x)) for n, x in system.parameters.items())
        )
    names = [*system.parameters, "q", "p"]
    rows = ((code(n), *(code(at[x]) for x in names)) for n, at in system.regimes.items())
    yield table(("regime", *names), rows)
    yield f"Source: {prose(system.source)}."
