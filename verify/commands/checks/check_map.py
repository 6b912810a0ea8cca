"""The command `verify check-map`: any map of one's own, without an H."""

import time
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import Answer, answering, picked
from verify.commands.shared.input import time_limit_option, values_of

if TYPE_CHECKING:
    from verify.integrators.maps.check import MapFinding


@click.command("check-map")
@click.argument("target", metavar="MODULE:FUNCTION")
@click.option("--degrees", type=int, default=1, show_default=True, metavar="N", help="Of freedom.")
@click.option(
    "--arguments",
    metavar="ORDER",
    help="Of a map(z) of one sequence: where the coordinates stand in it, such as q1,p1,q2,p2. "
    "Without it p1, …, pn, q1, …, qn.",
)
@click.option(
    "--param",
    "params",
    multiple=True,
    metavar="NAME=VALUE",
    help="A further argument that it takes by name; repeatable.",
)
@click.option("--q", "q", metavar="Q1,Q2", help="A point to look at beside others: q1, …, qn.")
@click.option("--p", "p", metavar="P1,P2", help="Its p1, …, pn.")
@time_limit_option
@answering
def check_map(
    target: str,
    degrees: int,
    arguments: str | None,
    params: tuple[str, ...],
    q: str | None,
    p: str | None,
    time_limit: float,
) -> Answer:
    """Check whether a Python function map(p, q) → (p', q') of your own is symplectic, without an H.

    p and q are numbers, or arrays of N numbers; or it is map(z) → z' of one array of 2 N numbers.
    Symplectic: JᵀΩJ = Ω at every point, J = ∂(p', q')/∂(p, q).

    THIS RUNS YOUR CODE: MODULE is imported, from the current folder too, or file.py:FUNCTION is
    loaded, and the function is called.

    Where its code allows it, the function is called with symbols, and all is proved; else it is
    measured. Exit status 1 where it is REFUTED, or nothing is found out.

    \b
    verify check-map mine.py:henon --degrees 1
    verify check-map ring.py:turn --degrees 2 --arguments q1,p1,q2,p2 --param strength=0.3
    """
    from verify.arithmetic.exact import rational
    from verify.integrators.loading import load
    from verify.integrators.maps.check import check_map as check
    from verify.integrators.maps.user_map import map_from, start_of

    begun = time.perf_counter()
    given = {n: rational(x, f"parameter {n}") for n, x in values_of(params).items()}
    own = map_from(load(target, "map"), degrees, arguments, given, time_limit)
    found = check(own, start_of(own, p, q))
    seconds = f"{time.perf_counter() - begun:.6f}"
    return Answer(
        lambda: _json(target, found, seconds),
        lambda: _print(target, found),
        failed=not found.verdict.holds,
    )


def _json(target: str, found: "MapFinding", seconds: str) -> dict[str, Any]:
    from verify.arithmetic.exact import text

    example = found.counterexample
    return {
        **picked(found, "verdict", "reason"),
        "map": target,
        **picked(found, "degrees", "how", "symplectic", "area_preserving"),
        "counterexample": example and {
            **{name: text(x) for name, x in example.items()},
            "entry": found.entry,
            "found": found.value,
        },
        "defect_max": None if found.largest is None else f"{found.largest:.6e}",
        "probe_error": None if found.probe_error is None else f"{found.probe_error:.1e}",
        **picked(found, "domain", "notes"),
        "seconds": seconds,
    }  # fmt: skip


def _print(target: str, found: "MapFinding") -> None:
    from verify.arithmetic.exact import text

    click.echo(f"{found.verdict}: {found.reason}")
    click.echo(f"  map      {target}")
    if found.counterexample is not None:
        at = ", ".join(f"{name} = {text(x)}" for name, x in found.counterexample.items())
        click.echo(f"  against  {found.entry} has {found.value} at {at}")
    if found.largest is not None:
        error = f"the probe's error {found.probe_error:.1e}"
        click.echo(f"  measured |S| up to {found.largest:.1e}; {error}")
    if found.area_preserving is not None:
        where = "" if found.how == "proof" else " where it was measured"
        click.echo(f"  det J    is {'' if found.area_preserving else 'not '}1{where}")
    for note in found.notes:
        click.echo(f"  note     {note}")
