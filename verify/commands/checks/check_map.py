"""The command `verify check-map`: any map of one's own, without an H."""

from typing import TYPE_CHECKING, Any

import click

from verify.commands.checks import check_options
from verify.commands.shared.execution_options import clock
from verify.commands.shared.input import time_limit_option, values_of
from verify.commands.shared.option import option
from verify.commands.shared.output import CommandAnswer, answering, pick
from verify.commands.shared.proof_output import point_json
from verify.commands.shared.structure_options import structure_options
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.integrators.results import Finding
    from verify.structures.reading import KeepsRequest


@click.command("check-map")
@click.argument("target", metavar="MODULE:FUNCTION")
@option(
    "--degrees", "N", "The number of degrees of freedom.", type=int, default=1, show_default=True
)
@option(
    "--arguments",
    "ORDER",
    "The order of the coordinates in the argument of a map(z), such as q1,p1,q2,p2. "
    "By default p1, …, pn, q1, …, qn.",
)
@option(
    "--param params",
    "NAME=VALUE",
    "A further argument that it takes by name; repeatable.",
    multiple=True,
)
@option(
    "--coordinates",
    "NAMES",
    "The names of its arguments, flattened, in their order, such as v1,v2,x1,x2; any number. "
    "By default p1, …, pn, q1, …, qn.",
)
@check_options.place_options
@check_options.point_option
@structure_options
@time_limit_option
@check_options.allow_undecided_option
@answering
def check_map(
    target: str,
    degrees: int,
    arguments: str | None,
    params: tuple[str, ...],
    coordinates: str | None,
    time_limit: float,
    allow_undecided: bool,
    keeps: "KeepsRequest",
    **place_texts: str | None,
) -> CommandAnswer:
    """Check whether a Python function map(p, q) → (p', q') of your own is symplectic, without an H.

    p and q are numbers, or arrays of N numbers; or the function is map(z) → z', where z is one
    array of 2 N numbers. Symplectic means JᵀΩJ = Ω at every point, J = ∂(p', q')/∂(p, q).

    THIS RUNS YOUR CODE: MODULE is imported, from the current folder too, or file.py:FUNCTION is
    loaded, and the function is called.

    With --coordinates, --keeps and what refines it, other structures are judged, and only those
    that are named; volume, if none is.

    If its code allows it, the function is called with symbols, and all is proved; otherwise it is
    measured. Exit status 1 if the verdict is REFUTED, or UNDECIDED without --allow-undecided.

    \b
    verify check-map mine.py:henon --degrees 1
    verify check-map ring.py:turn --degrees 2 --arguments q1,p1,q2,p2 --param strength=0.3
    verify check-map mine.py:push --coordinates v1,v2,v3,x1,x2,x3 --keeps volume
    verify check-map mine.py:two --coordinates v1,v2,x1,x2 --form "m1*dv1^dx1 + m2*dv2^dx2" \
        --param m1=1 --param m2=3
    """
    from verify.arithmetic.exact import rational
    from verify.hamiltonians.coordinates import check_degrees, coordinates_in
    from verify.integrators.map_claims import MapSystem, coordinates_from
    from verify.integrators.step_check import check_map as check
    from verify.integrators.user_code.coordinate_layout import callee_of_coordinates
    from verify.integrators.user_code.loading import callee_from, load

    check_degrees(degrees)
    names = coordinates_in(degrees)
    if coordinates is not None:
        names = coordinates_from(coordinates, "--coordinates")
    request = check_options.request_from(names, **place_texts)
    parameters = {n: rational(x, f"parameter {n}") for n, x in values_of(params).items()}
    function = load(target, "map")
    if coordinates is None:
        callee = callee_from(
            function, names, stepped=False, arguments=arguments, parameters=parameters,
            strict=True, time_limit=time_limit,
        )  # fmt: skip
    elif arguments is not None:
        raise InputError("--arguments", arguments, "goes without --coordinates")
    else:
        callee = callee_of_coordinates(
            function, names, stepped=False, parameters=parameters, time_limit=time_limit
        )
    with_keeps = bool(keeps) or coordinates is not None
    with clock(target):
        claims = MapSystem(names, parameters).read(keeps) if with_keeps else []
        finding = check(callee, claims, request)
    return CommandAnswer(
        lambda: _json(target, names, finding),
        lambda: _print(target, finding, with_keeps=with_keeps),
        timed=True,
        failed=check_options.is_failure([finding.verdict], allow_undecided=allow_undecided),
    )


def _json(target: str, names: tuple[str, ...], finding: "Finding") -> dict[str, Any]:
    example = finding.counterexample
    return {
        **pick(finding, "verdict", "reason"),
        "map": target,
        **pick(finding, "degrees", "how", "symplectic", "area_preserving"),
        "counterexample": example and {
            **point_json(example.z),
            "entry": finding.entry,
            "found": example.found,
        },
        "defect_max": None if finding.largest is None else f"{finding.largest:.6e}",
        "probe_error": None if finding.probe_error is None else f"{finding.probe_error:.1e}",
        "places": check_options.places_json(names, finding.places),
        "keeps": check_options.keeps_json(finding),
        **pick(finding, "domain", "faults", "notes"),
    }  # fmt: skip


def _print(target: str, finding: "Finding", *, with_keeps: bool) -> None:
    click.echo(f"{finding.verdict}: {finding.reason}")
    click.echo(f"  map      {target}")
    if finding.how == "proof" and finding.area_preserving is not None:
        click.echo(f"  det J    is {'' if finding.area_preserving else 'not '}1")
    else:
        check_options.print_measured(finding)
    if with_keeps:
        check_options.print_keeps(finding)
    check_options.print_notes(finding)
