"""The command `verify stability`: verdicts on the runs of a scene, and exact linear theory.

`verify stability --linear`: a scheme on the harmonic oscillator, or at an equilibrium of H.
"""

import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from verify.arithmetic.exact import plain, positive, rational, text
from verify.commands.shared.execution_options import perform, with_tasks
from verify.commands.shared.input import hamiltonian_of, parse_coordinates
from verify.commands.shared.option import flag, option
from verify.commands.shared.output import CommandAnswer, print_once
from verify.commands.shared.scene_options import scenes_of, start_options, with_one_line
from verify.errors import NOT_GIVEN, InputError

if TYPE_CHECKING:
    from verify.studies.stability.equilibrium import LinearAtEquilibrium
    from verify.studies.stability.linear_stability import LinearStability

_EQUILIBRIUM_OPTIONS = ("system", "hamiltonian", "params", "q", "p", "step_sizes")
_SHOWN_DIGITS = 12  # on a terminal
_MAX_FREQUENCIES = 12  # on a terminal
_BOUNDED_TEXT = {
    True: "bounded",
    False: "unbounded",
    None: "undecided: its coefficients are irrational",
}


def linear_answer(scene: str | None, options: Mapping[str, Any]) -> CommandAnswer:
    """Return the answer of linear theory. Raises InputError for options that do not go with it."""
    if scene is not None:
        raise InputError("SCENE", scene, "does not go with --linear; leave it out")
    has_hamiltonian = options["system"] is not None or options["hamiltonian"] is not None
    for name, x in options.items():
        # Without an H the scheme is the only option: hω is the only variable of the oscillator.
        is_allowed = name == "schemes" or (has_hamiltonian and name in _EQUILIBRIUM_OPTIONS)
        if not is_allowed and x not in (None, ()):
            value_text = x[0] if isinstance(x, tuple) else x
            raise InputError(name, value_text, "does not go with --linear; leave it out")
    if len(options["schemes"]) != 1:
        value_text = ", ".join(options["schemes"]) or NOT_GIVEN
        raise InputError("schemes", value_text, "give one with --linear")
    scheme = str(options["schemes"][0])
    return (
        _answer_at_equilibrium(scheme, options)
        if has_hamiltonian
        else _answer_for_oscillator(scheme)
    )


def _answer_for_oscillator(scheme: str) -> CommandAnswer:
    from verify.algebra.expressions.formula_text import to_text
    from verify.studies.stability.scheme_interval import linear_stability

    theory = linear_stability(scheme)
    data = {
        "scheme": theory.scheme,
        "interval": theory.decimal(),
        "interval_exact": theory.exact,
        "note": theory.note,
        "delta_j": to_text(theory.delta_j),
    }
    return CommandAnswer(lambda: data, lambda: _print_oscillator(theory, data["delta_j"]))


def _print_oscillator(theory: "LinearStability", delta_j: str) -> None:
    special_ranges = {"infinite": "for every hω > 0", "0": "for no hω > 0"}
    range_text = special_ranges.get(theory.exact, f"for 0 < hω < {theory.decimal(_SHOWN_DIGITS)}")
    click.echo(f"{theory.scheme} on the harmonic oscillator is stable {range_text}")
    if theory.exact and theory.exact not in special_ranges and not theory.exact.isdecimal():
        click.echo(f"  exactly  {theory.exact}")
    if theory.note:
        click.echo(f"  note     {theory.note}")
    click.echo(f"  ΔJ       {delta_j}, y = hω")


def _answer_at_equilibrium(scheme: str, options: Mapping[str, Any]) -> CommandAnswer:
    from verify.hamiltonians.run_domain import point_of
    from verify.studies.stability.equilibrium import linear_at_equilibrium

    hamiltonian = hamiltonian_of(options["system"], options["hamiltonian"], options["params"])
    origin = ",".join(["0"] * hamiltonian.degrees)
    q, p = (parse_coordinates(options[name] or origin, hamiltonian) for name in ("q", "p"))
    sizes = [positive(h, "step_size") for h in options["step_sizes"]]
    theory = linear_at_equilibrium(hamiltonian, scheme, point_of(hamiltonian, q, p), sizes)
    return CommandAnswer(lambda: _equilibrium_json(theory), lambda: _print_equilibrium(theory))


def _equilibrium_json(theory: "LinearAtEquilibrium") -> dict[str, Any]:
    from verify.hamiltonians.run_domain import coordinate_texts

    hamiltonian, interval = theory.hamiltonian, theory.interval
    return {
        "scheme": theory.scheme,
        **hamiltonian.texts,
        "q": coordinate_texts(hamiltonian, theory.point, "q"),
        "p": coordinate_texts(hamiltonian, theory.point, "p"),
        "frequencies": [
            {"value": f.decimal(), "exact": f.exact, "multiplicity": f.multiplicity}
            for f in theory.frequencies
        ],
        "oscillates": theory.oscillates,
        "interval": None if interval is None else interval.decimal(),
        "interval_exact": None if interval is None else interval.exact,
        "note": "" if interval is None else interval.note,
        "step_size": theory.step_size,
        "step_size_exact": theory.step_size_exact,
        "decided": [
            {"step_size": text(h), "bounded": bounded} for h, bounded in theory.decided.items()
        ],
    }


def _print_equilibrium(theory: "LinearAtEquilibrium") -> None:

    point_text = (
        ", ".join(f"{name} = {text(x)}" for name, x in theory.point.items() if x) or "the origin"
    )
    click.echo(f"{theory.scheme} on the quadratic part of H at {point_text}")
    click.echo(f"  ω          {_format_frequencies(theory)}")
    if theory.interval is not None:
        limit = theory.step_size
        special_ranges = {"infinite": "every h > 0", "0": "no h > 0"}
        if limit in special_ranges:
            click.echo(f"  bounded    for {special_ranges[limit]}")
        else:
            reach = f"hω = {theory.interval.decimal(_SHOWN_DIGITS)} with the greatest ω"
            limit_text = plain(rational(limit or 0), _SHOWN_DIGITS)
            click.echo(f"  bounded    for 0 < h < {limit_text}, until {reach}")
        if theory.step_size_exact:
            click.echo(f"  exactly    {theory.step_size_exact}")
        if theory.interval.note:
            click.echo(f"  note       {theory.interval.note}")
    for h, bounded in theory.decided.items():
        click.echo(f"  h = {text(h):6} {_BOUNDED_TEXT[bounded]}")


def _format_frequencies(theory: "LinearAtEquilibrium") -> str:
    values = [
        f.decimal(_SHOWN_DIGITS) + f" ({f.multiplicity} times)" * (f.multiplicity > 1)
        for f in theory.frequencies
    ]
    # The highest frequency limits the step size.
    if len(values) > _MAX_FREQUENCIES:
        values = [values[0], values[1], "…", *values[-2:]]
    remark = "" if theory.oscillates else "none for the other degrees of freedom"
    return ", ".join(filter(None, (*values, remark)))


if TYPE_CHECKING:
    from verify.execution.executors import Placement
    from verify.studies.kinds.stability import StabilityFindings

_KINDS_WITHOUT_DETAIL = ("stable", "drifts")  # nothing is to blame
_LINE_WIDTH, _INDENT = 100, " " * 6


@click.command()
@with_one_line(
    option("--steps", "N", "The number of steps, at least 1; or give --time.", type=int),
    option("--time", "T", "N is T/H rounded down."),
)
@start_options
@flag(
    "--linear",
    "Judge one scheme on the harmonic oscillator, or at an equilibrium of H, by algebra.",
)
@with_tasks
def stability(
    scene: str | None, linear: bool, keep: Path | None, placement: "Placement", **options: Any
) -> CommandAnswer:
    """Judge the runs of SCENE: a TOML file, `paper`, or the suites `stiff` and `extreme`.

    The verdicts: stable, drifts, unstable: scheme, unstable: arithmetic, escapes, overflow at step
    k, underflow; and in n degrees of freedom sensitive, if neighbours of the exact motion part from
    it. Only the [[stability]], [[largest_step]], [[stability_map]] and [[orbit_map]] of the scene
    are computed.

    \b
    verify stability stiff
    verify stability --system pendulum --scheme lie2 --step-size 0.1 --time 100 --q 1 --p 0
    verify stability --linear --scheme lie4
    verify stability --linear --scheme rk4 --system fput --param n=8 --param alpha=1 --param beta=0
    """
    if linear:
        return linear_answer(scene, options)
    from verify.execution.plan import plan_of
    from verify.scenes.values import describe_rounding
    from verify.studies.kinds.stability import findings_of, need_stability

    scenes = scenes_of(scene, options, ("q", "p"), _build_section)
    plan = plan_of(scenes, need_stability)
    if not plan.tasks:
        problem = "asks for no [[stability]], [[largest_step]], [[stability_map]] or [[orbit_map]]"
        raise InputError("SCENE", scene or NOT_GIVEN, problem)
    findings = findings_of(scenes, perform(plan, keep, placement))
    notes = [
        describe_rounding(section.time, section.step_sizes)
        for scene in scenes
        for section in scene.stability
    ]

    def show() -> None:
        _print(findings)
        print_once(notes)

    return CommandAnswer(findings.as_json, show)


def _build_section(*, q: Any, p: Any, **section_keys: Any) -> dict[str, Any]:
    return {"stability": [{**section_keys, "initial_values": [{"q": q, "p": p}]}]}


def _print(findings: "StabilityFindings") -> None:
    width = max((len(run.verdict) for run in findings.stability), default=0)
    for run in findings.stability:
        click.echo(f"{run.verdict:{width}}  {run.id}")
        if run.kind not in _KINDS_WITHOUT_DETAIL:
            detail = textwrap.fill(
                run.detail, _LINE_WIDTH, initial_indent=_INDENT, subsequent_indent=_INDENT
            )
            click.echo(detail)
    for result in findings.largest_steps:
        range_text, detail = f"bounded up to h = {result.bounded}", str(result.detail)
        if result.bounded is None:
            range_text = "never bounded"
        elif result.unbounded is None:
            # No step size that was tried is unbounded: the detail begins the sentence.
            range_text, detail = f"{detail}, the largest h = {result.bounded},", ""
        linear = (
            f"linear theory {result.linear}" if result.linear else "linear theory sets no limit"
        )
        limits = [f"energy error ≤ {result.energy_error}"] * bool(result.energy_error)
        limits += [f"|W| ≤ {result.symplectic_defect}"] * bool(result.symplectic_defect)
        condition = f" with {' and '.join(limits)}" if limits else ""
        sentence = f"{range_text}{condition} until t = {result.time}; {linear}  {detail}"
        click.echo(f"{result.scheme}: {sentence}")
    for stability_map in findings.stability_maps:
        counts = ", ".join(f"{n} {kind}" for kind, n in stability_map.counted().items())
        click.echo(f"{stability_map.scheme}: {stability_map.parameter} and step size: {counts}")
    for orbit_map in findings.orbit_maps:
        counts = ", ".join(f"{n} {kind}" for kind, n in orbit_map.counted().items())
        click.echo(f"{orbit_map.scheme}: orbits over {' and '.join(orbit_map.axes)}: {counts}")
