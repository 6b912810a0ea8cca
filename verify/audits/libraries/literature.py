"""Coefficient tables of splitting methods, as they are printed.

The data are in `reports/audits/literature.toml`.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from verify.audits.methods.integrator import ReleasedIntegrator
from verify.content import content
from verify.integrators.tables.splitting_claims import alternating, mirror
from verify.scenes.toml_file import read_toml
from verify.schemes.printed.printed_numbers import PrintedNumbers
from verify.schemes.printed.splitting_table import PrintedTable

TITLE = "printed tables"
LIBRARY = None
LEFT_OUT = (
    (
        "OrdinaryDiffEqSymplecticRK's McAte42",
        "its documentation says that it is broken, so that no order is claimed of it",
    ),
    (
        "a force that depends on time",
        "a table has no clock: which time kicks and drifts read is in code that is not run here",
    ),
)
_KINDS = {
    "splitting": "for every H = T(p) + V(q)",
    "nystrom": "for every H = T(p) + V(q) with quadratic T",
    "composition": "composing any symmetric step of order 2",
}


def integrators() -> Iterator[ReleasedIntegrator]:
    for entry in read_toml(Path(content("reports", "audits", "literature.toml")))["table"]:
        yield ReleasedIntegrator(
            entry["name"],
            f"its coefficients as exact decimals, {_KINDS[entry['kind']]}; read in {entry['read']}",
            entry["source"],
            table_of(entry),
            entry["order"],
            reproduction=_script(entry),
        )


def table_of(entry: Mapping[str, Any]) -> PrintedTable:
    """Return the table of one entry of the file."""
    sizes = entry.get("sizes") or mirror(entry["half"])
    parts = tuple(zip(_names(entry, len(sizes)), sizes, strict=True))
    return PrintedTable(entry["kind"], parts, PrintedNumbers(entry.get("numbers", {})))


def _names(entry: Mapping[str, Any], count: int) -> tuple[str, ...]:
    if entry["kind"] == "composition":
        return ("step",) * count
    return alternating(entry["first"], count)


def _script(entry: Mapping[str, Any]) -> str:
    """Write the step in plain Python, for the pendulum, and the slope of its error."""
    table = table_of(entry)
    numbers = [f"{name} = {value.strip()}\n" for name, value in table.printed.numbers.items()]
    parts = ", ".join(f'("{kind}", {size})' for kind, size in table.parts)
    step = _STEPS[entry["kind"]]
    return _SCRIPT.format(numbers="".join(numbers), parts=parts, step=step, order=entry["order"])


_ALTERNATING = """\
        if kind == "kick":
            p = p - a * h * sin(q)
        else:
            q = q + a * h * """
_STEPS = {
    "splitting": f"{_ALTERNATING}sin(p)",
    "nystrom": f"{_ALTERNATING}p",
    "composition": """\
        p = p - a * h / 2 * sin(q)
        q = q + a * h * p
        p = p - a * h / 2 * sin(q)""",
}
_SCRIPT = """\
from math import log2, sin

{numbers}parts = [{parts}]


def step(p, q, h):
    for kind, a in parts:
{step}
    return p, q


def error(h):  # against many steps a hundred times smaller
    x = step(1.0, 0.5, h)
    y = (1.0, 0.5)
    for _ in range(100):
        y = step(*y, h / 100)
    return max(abs(x[0] - y[0]), abs(x[1] - y[1]))


# the error of one step is O(h^r), r = order + 1; claimed: order {order}
print(log2(error(0.2) / error(0.1)))"""
