"""Truncation and rounding in Λ, or in n degrees of freedom in W, as `verify separate` tells it."""

import textwrap
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared.answer import picked
from verify.commands.shared.output import plain_json

if TYPE_CHECKING:
    from verify.scenes.results.separation import (
        CrossoverResult,
        EvaluationResult,
        Parts,
        SeparationGrid,
        SeparationResult,
    )
    from verify.scenes.results.separation_in_degrees import (
        FormEvaluation,
        FormParts,
        SeparationGridInDegrees,
        SeparationInDegrees,
    )

    Grid = SeparationGrid | SeparationGridInDegrees
    Point = SeparationResult | SeparationInDegrees
    Evaluation = EvaluationResult | FormEvaluation

_WIDTH = 88  # of a line of prose
_LABELS = {"plain": "plain", "closed_form": "closed form"}


def separation_json(found: "Grid") -> dict[str, Any]:
    """The first step size's parts, and those of all of them as `grid`; of W each is a matrix."""
    points = [_separated(point) for point in found.points]
    crossover = {way: getattr(found, way).model_dump(mode="json") for way in _LABELS}
    seconds = f"{sum(point.seconds for point in found.points):.6f}"
    return {**points[0], "crossover": crossover, "grid": points, "seconds": seconds}


def _separated(point: "Point") -> dict[str, Any]:
    from verify.scenes.results.separation import Parts, SeparationResult
    from verify.scenes.results.separation_in_degrees import FormParts

    parts: type[Parts | FormParts] = Parts
    names: dict[str, Any] = {}
    motion: dict[str, Any] = {}
    if not isinstance(point, SeparationResult):
        parts, names = FormParts, {"coordinates": list(point.coordinates)}
        motion = {"tangent": plain_json(point.tangent) if point.tangent else None}
    return {
        **names,
        **_evaluated(point.plain, parts),
        "closed_form": _evaluated(point.closed_form, parts),
        **motion,
        **picked(point, "step_size", "steps", "digits"),
        "working_arithmetic": "float64",
        **picked(point, "arithmetic", "error_method", "status", "failed_step", "reason"),
        "seconds": f"{point.seconds:.6f}",
    }


def _evaluated(way: "Evaluation | None", parts: "type[Parts | FormParts]") -> dict[str, Any]:
    """`parts`: how they are called where there are none."""
    names = (type(way.parts) if way else parts).model_fields
    values = {n: getattr(way.parts, n) if way else None for n in names}
    working, *_ = names
    shown = {n: value.value if value else None for n, value in values.items()}
    law = getattr(way, "law", None)  # of W alone
    return {
        working: shown.pop(working),
        "truncation": shown.pop("truncation"),
        "rounding": shown,
        "error_bound": {n: value.bound for n, value in values.items() if value},
        "error_kind": way.error_kind if way else None,
        "largest": way.largest if way else None,
        "growth": {n: plain_json(g) for n, g in way.growth.items()} if way else None,
        **({"law": law and plain_json(law)} if working == "w_working" else {}),
        "series": [point.model_dump(mode="json") for point in way.series] if way else [],
    }


def print_separation(found: "Grid") -> None:
    """Each step size, and where rounding overtakes truncation."""
    from verify.scenes.results.separation import SeparationResult

    for point in found.points:
        click.echo(f"h = {point.step_size}, {point.steps} steps")
        if point.status != "finished":
            at = f" at step {point.failed_step}" if point.failed_step else ""
            click.echo(f"  {point.status}{at}: {point.reason}")
        elif isinstance(point, SeparationResult):
            _print_parts(point)
        else:
            _print_form(point)
    if len(found.points) > 1:
        for way, label in _LABELS.items():
            click.echo(f"rounding overtakes truncation, {label}: {_crossed(getattr(found, way))}")


def _print_parts(point: "SeparationResult") -> None:
    from verify.scenes.results.separation import SHOWN

    ways = [way for way in (point.plain, point.closed_form) if way]
    labels = SHOWN | {name: f"  {name}" for name in ways[0].parts.of_rounding}
    click.echo(f"  {'':16}{'plain':26}{'closed form' if len(ways) > 1 else ''}")
    for name, label in labels.items():
        _print_cells(label, (getattr(way.parts, name).value for way in ways), 26)
    for label, way in zip(_LABELS.values(), ways, strict=False):
        growth = way.growth["total"]
        click.echo(f"  rounding with N, {label}: {growth.name} ({growth.reason})")
    if len(ways) < 2:
        click.echo("  no closed form: some det J ≤ 0, which has no logarithm")
    _print_computed(point, ways[0].error_kind)


def _print_form(point: "SeparationInDegrees") -> None:
    from verify.scenes.results.separation_in_degrees import FORM_SHOWN

    ways: Mapping[str, FormEvaluation] = {way: getattr(point, way) for way in _LABELS}
    labels = FORM_SHOWN | {name: f"  {name}" for name in ways["plain"].parts.of_rounding}
    click.echo(f"  {'greatest entry':16}{'plain':38}closed form")
    for name, label in labels.items():
        cells = []
        for way in ways.values():
            own = getattr(way.parts, name)
            at = point.name_of(own.place) if own.largest.exact else ""
            cells.append(f"{own.largest.value:24} {at}")
        _print_cells(label, cells, 38)
    for key, label in _LABELS.items():
        law = ways[key].law
        click.echo(f"  max |W| with N, {label}: {law.name} ({law.reason}; measured, not proved)")
    if tangent := point.tangent:
        click.echo(
            f"  tangent map: ‖M‖² = {float(tangent.norm_squared):.3g}, "
            f"‖∧²M‖ = {float(tangent.areas):.3g}, finite-time Lyapunov exponent "
            f"{tangent.finite_time_lyapunov} over T = {tangent.time}"
        )
        meaning = textwrap.fill(str(tangent.meaning), _WIDTH, subsequent_indent="  ")
        click.echo(f"  {meaning}")
    _print_computed(point, ", ".join(dict.fromkeys(way.error_kind for way in ways.values())))


def _print_cells(label: str, cells: Iterable[str], width: int) -> None:
    click.echo(f"  {label:16}" + "".join(f"{cell:{width}}" for cell in cells).rstrip())


def _print_computed(point: "Point", kinds: str) -> None:
    click.echo(
        f"  {point.arithmetic} as exact arithmetic, {point.seconds:.3g} s; "
        f"bounds {kinds} ({point.error_method})"
    )


def _crossed(way: "CrossoverResult") -> str:
    if way.bracket is None:
        return way.reason
    return f"h* = {way.step_size or '?'}, {way.bracket[0]} … {way.bracket[1]} ({way.reason})"
