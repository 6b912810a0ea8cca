"""Truncation and rounding in W as `verify separate` tells them, in n degrees of freedom."""

import textwrap
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import picked
from verify.commands.shared.output import crossed, plain_json

if TYPE_CHECKING:
    from verify.scenes.results.separation_in_degrees import (
        FormEvaluation,
        SeparationGridInDegrees,
        SeparationInDegrees,
    )

_WIDTH = 88  # of a line of prose
_LABELS = {"plain": "plain", "closed_form": "closed form"}


def as_json(found: "SeparationGridInDegrees") -> dict[str, Any]:
    """The first step size's parts, and those of all of them as `grid`; every part is a matrix."""
    points = [_separated(point) for point in found.points]
    crossover = {way: getattr(found, way).model_dump(mode="json") for way in _LABELS}
    seconds = f"{sum(point.seconds for point in found.points):.6f}"
    return {**points[0], "crossover": crossover, "grid": points, "seconds": seconds}


def _separated(point: "SeparationInDegrees") -> dict[str, Any]:
    return {
        "coordinates": list(point.coordinates),
        **_evaluated(point.plain),
        "closed_form": _evaluated(point.closed_form),
        "tangent": plain_json(point.tangent) if point.tangent else None,
        **picked(point, "step_size", "steps", "digits"),
        "working_arithmetic": "float64",
        **picked(point, "arithmetic", "error_method", "status", "failed_step", "reason"),
        "seconds": f"{point.seconds:.6f}",
    }


def _evaluated(way: "FormEvaluation | None") -> dict[str, Any]:
    from verify.scenes.results.separation_in_degrees import FormParts

    names = (type(way.parts) if way else FormParts).model_fields
    values = {n: getattr(way.parts, n) if way else None for n in names}
    shown = {n: [list(row) for row in x.value] if x else None for n, x in values.items()}
    return {
        "w_working": shown.pop("w_working"),
        "truncation": shown.pop("truncation"),
        "rounding": shown,
        "error_bound": {n: [list(row) for row in x.bound] for n, x in values.items() if x},
        "error_kind": way.error_kind if way else None,
        "largest": way.largest if way else None,
        "growth": {n: plain_json(g) for n, g in way.growth.items()} if way else None,
        "law": plain_json(way.law) if way else None,
        "series": [point.model_dump(mode="json") for point in way.series] if way else [],
    }


def print_separation(found: "SeparationGridInDegrees") -> None:
    """Each step size, and where rounding overtakes truncation."""
    for point in found.points:
        click.echo(f"h = {point.step_size}, {point.steps} steps")
        if point.status == "finished":
            _print_point(point)
        else:
            at = f" at step {point.failed_step}" if point.failed_step else ""
            click.echo(f"  {point.status}{at}: {point.reason}")
    if len(found.points) > 1:
        for way, label in _LABELS.items():
            click.echo(f"rounding overtakes truncation, {label}: {crossed(getattr(found, way))}")


def _print_point(point: "SeparationInDegrees") -> None:
    from verify.scenes.results.separation_in_degrees import FORM_SHOWN

    ways = {way: getattr(point, way) for way in _LABELS}
    parts = {name: f"  {name}" for name in ways["plain"].parts.of_rounding}
    click.echo(f"  {'greatest entry':16}{'plain':38}closed form")
    for name, label in (FORM_SHOWN | parts).items():
        cells = []
        for way in ways.values():
            own = getattr(way.parts, name)
            at = point.name_of(own.place) if own.largest.exact else ""
            cells.append(f"{own.largest.value:24} {at}")
        click.echo(f"  {label:16}" + "".join(f"{cell:38}" for cell in cells).rstrip())
    for way, label in _LABELS.items():
        law = ways[way].law
        click.echo(f"  max |W| with N, {label}: {law.name} ({law.reason}; measured, not proved)")
    if tangent := point.tangent:
        click.echo(
            f"  tangent map: ‖M‖² = {float(tangent.norm_squared):.3g}, "
            f"‖∧²M‖ = {float(tangent.areas):.3g}, finite-time Lyapunov exponent "
            f"{tangent.finite_time_lyapunov} over T = {tangent.time}"
        )
        meaning = textwrap.fill(str(tangent.meaning), _WIDTH, subsequent_indent="  ")
        click.echo(f"  {meaning}")
    kinds = ", ".join(dict.fromkeys(way.error_kind for way in ways.values()))
    click.echo(
        f"  {point.arithmetic} as exact arithmetic, {point.seconds:.3g} s; "
        f"bounds {kinds} ({point.error_method})"
    )
